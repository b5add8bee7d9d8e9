#include "app/leave_one_out.h"

#include "app/chart_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace app
{
namespace
{
using io::ChartRow;
using Kind = Verdict::Kind;

Verdict judge(const std::string& scene, const std::vector<ChartRow>& rows, Real error)
{
    Verdict verdict;
    verdict.scene = scene;
    const ChartRow* first = nullptr;
    Real least = std::numeric_limits<Real>::infinity();
    for (const ChartRow& row : rows) {
        if (row.scene != scene) continue;
        if (!first) first = &row;
        if (row.status == "done" && row.error <= error) least = std::min(least, row.cpu_s);
    }
    if (!std::isfinite(least)) {
        verdict.kind = Kind::unreachable;
        return verdict;
    }
    const AdviceRequest request{first->file, {}, error, first->length_mm, {scene}};
    verdict.advice = advise(request, rows).advice;
    if (!verdict.advice) return verdict;
    const ChartRow* held = nullptr;   // coarsest that is not coarser than advised
    const ChartRow* finest = nullptr; // of the coarser ones
    for (const ChartRow& row : rows) {
        if (row.scene != scene || !same_method(row, verdict.advice->method) || row.status == "not applicable" ||
            row.status == "pending" || (row.levels > 1) != (verdict.advice->method.levels > 1))
            continue;
        if (row.finest_mm <= verdict.advice->finest_mm * (1 + 1e-6)) {
            if (!held || row.finest_mm > held->finest_mm) held = &row;
        } else if (!finest || row.finest_mm < finest->finest_mm)
            finest = &row;
    }
    if (!held && finest && finest->status == "done" && finest->error <= error) held = finest;
    if (!held) {
        verdict.kind = Kind::unmeasured;
        return verdict;
    }
    verdict.kind = held->status == "done" && held->error <= error ? Kind::met : Kind::missed;
    verdict.tested = held->setting;
    verdict.error = held->error;
    verdict.cost_over_best = held->cpu_s / least;
    return verdict;
}

std::string kind_text(Kind kind)
{
    switch (kind) {
    case Kind::met:
        return "met";
    case Kind::missed:
        return "missed";
    case Kind::unmeasured:
        return "not measured there";
    case Kind::no_advice:
        return "no advice";
    case Kind::unreachable:
        return "no run of the scene is that accurate";
    }
    return "";
}
} // namespace

std::vector<Verdict> leave_one_out(const std::vector<ChartRow>& rows, Real error)
{
    std::vector<Verdict> verdicts;
    for (const ChartRow& row : rows)
        if (verdicts.empty() || verdicts.back().scene != row.scene) verdicts.push_back(judge(row.scene, rows, error));
    return verdicts;
}

std::string leave_one_out_text(const std::vector<Verdict>& verdicts, Real error)
{
    std::string text =
        fmt::format("{:<20} {:<36} {:>10} {:>10}   {}\n", "scene", fmt::format("advice for {:.3g} %", 100 * error),
                    "error", "cost/best", "run it was held against");
    int met = 0, tested = 0;
    for (const Verdict& v : verdicts) {
        met += v.kind == Kind::met;
        tested += v.kind == Kind::met || v.kind == Kind::missed;
        text += fmt::format("{:<20} {:<36} {:>10} {:>10}   {}\n", v.scene, kind_text(v.kind),
                            std::isfinite(v.error) ? fmt::format("{:.3g} %", 100 * v.error) : "-",
                            std::isfinite(v.cost_over_best) ? fmt::format("{:.2g}", v.cost_over_best) : "-", v.tested);
    }
    return text +
           fmt::format("the advised setting met the error on {} of {} scenes where that was measured\n", met, tested);
}
} // namespace app
