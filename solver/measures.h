/// The named results of a run: peak force, crack initiations, crack path, lost energy (the contract of run.json).
#pragma once

#include "solver/problem.h"
#include "solver/state.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace solver
{
/// A number with its contract name; empty where the run does not have it (reported as null).
struct Measure
{
    std::string name;
    std::optional<Real> value;
};

/// What is measured at crack initiations, where a case names ligaments.
inline constexpr std::array<std::string_view, 9> event_measures{"c1_force_N", "c1_mean_N", "c1_cod_mm",
                                                                "c2_force_N", "c2_mean_N", "c2_cod_mm",
                                                                "c3_force_N", "c3_mean_N", "c3_cod_mm"};

struct Measures
{
    std::vector<Measure> numbers; // always the same names in the same order
    std::string crack_path;       // such as "A-D-C-E", empty: no ligament separated
};

/// Ligaments (indices) whose first broken column is a crack initiation, in time order: those of the crack path and, of
/// the ones that continue it and have begun, the one that is cut furthest, at equal share the first.
std::vector<std::size_t> crack_initiations(const Problem& problem, const std::vector<LigamentState>& ligaments);

/// Names: peak_force_N; c1_force_N, c1_mean_N, c1_cod_mm, c2_..., c3_...; energy_residual.
///
/// peak_force_N     largest force of the history (`specimen_force`)
/// cK_...           crack initiation K: force and COD at the first through-broken column of a ligament. Counted are the
///                  ligaments of the crack path and the one that continues it but is not separated yet, in the order of
///                  their first broken columns; C1 to C3 of Yang et al. 2014, Table 1
/// cK_mean_N        mean force of the history lines up to then whose COD is within `Problem::mean_over` of it; none
///                  where that is 0. The force rings after a crack, so one line says little
/// energy_residual  1, ledger residual over external work of the last line
Measures measures(const Problem& problem, const std::vector<HistoryLine>& history,
                  const std::vector<LigamentState>& ligaments);

/// Names of the numbers that runs of a case have: those of `measures` and those it asks for.
std::vector<std::string> measure_names(const Problem& problem);

/// Name of the published number that a measure is compared with: cK_force_N for cK_mean_N, else the same.
std::string published_name(const std::string& measure);

/// Force on the specimen [N]: mean of the two loads where both are named (what differs is momentum of the body), else
/// the one that is.
Real specimen_force(const Problem& problem, Real force_upper, Real force_lower);
} // namespace solver
