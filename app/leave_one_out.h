/// How good the advice of a chart is: each scene advised from all others, and held against its own runs.
#pragma once

#include "app/advise.h"

namespace app
{
struct Verdict
{
    enum class Kind
    {
        met,        // the advised setting met the error
        missed,     // it did not
        unmeasured, // the scene has no run of that method at least as coarse as its grid and as fine as advised
        no_advice,
        unreachable, // no run of the scene met the error: nothing to advise right
    };
    std::string scene;
    Kind kind = Kind::no_advice;
    std::optional<Advice> advice;
    std::string tested;                       // setting of the run it was held against
    Real error = io::ChartRow::none;          // of that run
    Real cost_over_best = io::ChartRow::none; // its processor time over the least with which the scene met the error
};

/// One verdict per scene. The run that is held against advice is the coarsest one of the advised method that is not
/// coarser than advised, or, if only coarser ones exist, the finest of those provided it meets the error even so.
std::vector<Verdict> leave_one_out(const std::vector<io::ChartRow>& rows, Real error);

std::string leave_one_out_text(const std::vector<Verdict>& verdicts, Real error);
} // namespace app
