#include "app/advise.h"

#include "app/chart_summary.h"
#include "app/forecast.h"
#include "app/median.h"
#include "core/error.h"
#include "io/case.h"
#include "refine/estimate.h"
#include "solver/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace app
{
namespace
{
using io::ChartRow;

constexpr Real least_order = 0.5; // below, extrapolation would promise nothing that a finite cell keeps
constexpr Real most_order = 2;    // above, it would promise more than the scheme has
constexpr int far = 3;            // a distance from which on scenes say little about each other

bool usable(const ChartRow& row)
{
    return row.status == "done" && std::isfinite(row.error) && row.cpu_s > 0 && row.length_mm > 0;
}

bool same_columns(const ChartRow& a, const ChartRow& b)
{
    return same_method(a, b) && (a.levels > 1) == (b.levels > 1);
}

/// Overrides that the columns do not tell: `dilatation=point` and the like. Their rows are no candidates.
bool has_other_overrides(const ChartRow& row)
{
    std::size_t begin = 0;
    while (begin < row.overrides.size()) {
        const std::string_view rest = std::string_view(row.overrides).substr(begin);
        const bool told = rest.starts_with("numerics.") || rest.starts_with("grid.cell=") ||
                          rest.starts_with("grid.levels=") || rest.starts_with("grid.particles_per_cell=") ||
                          rest.starts_with("refine.");
        if (!told) return true;
        begin += std::min(rest.find("; "), rest.size() - 2) + 2;
    }
    return false;
}

SceneFeatures features_of(const solver::Problem& problem, const AdviceRequest& request)
{
    SceneFeatures features = scene_features(problem);
    if (request.length) features.length = *request.length;
    return features;
}

/// Rows of one method on one scene.
using Group = std::vector<const ChartRow*>;

struct Candidate
{
    const ChartRow* method;
    std::map<std::string, Group> scenes;
};

std::vector<Candidate> candidates(const std::vector<const ChartRow*>& rows)
{
    std::vector<Candidate> all;
    for (const ChartRow* row : rows) {
        if (row->status == "not applicable" || row->status == "pending" || has_other_overrides(*row)) continue;
        auto found =
            std::find_if(all.begin(), all.end(), [&](const Candidate& c) { return same_columns(*c.method, *row); });
        if (found == all.end()) found = all.insert(all.end(), {row, {}});
        found->scenes[row->scene].push_back(row);
    }
    return all;
}

/// Processor time per particle-step, the median of the rows long enough to be more than their start.
Real step_cost(const Candidate& candidate)
{
    std::vector<Real> costs, short_ones;
    for (const auto& [scene, group] : candidate.scenes)
        for (const ChartRow* row : group)
            if (usable(*row) && row->particle_steps > 0)
                (row->cpu_s > 0.5 ? costs : short_ones).push_back(row->cpu_s / row->particle_steps);
    const std::vector<Real>& taken = costs.empty() ? short_ones : costs;
    return taken.empty() ? std::numeric_limits<Real>::infinity() : median(taken);
}

std::vector<std::string> method_overrides(const ChartRow& method, Real cell, const solver::Problem& problem)
{
    std::vector<std::string> set{fmt::format("numerics.formulation={}", method.formulation),
                                 fmt::format("numerics.basis={}", method.basis),
                                 fmt::format("numerics.transfer={}", method.transfer),
                                 fmt::format("numerics.stress_update={}", method.stress_update),
                                 fmt::format("numerics.precision={}", method.precision),
                                 fmt::format("numerics.pic_fraction={}", method.pic_fraction),
                                 fmt::format("numerics.cfl={}", method.cfl),
                                 fmt::format("grid.particles_per_cell={}", std::lround(method.particles_per_cell)),
                                 fmt::format("grid.cell={}", cell)};
    if (method.levels < 2 && problem.grid.levels > 1) {
        set.emplace_back("grid.levels=1");
        set.emplace_back("refine.zone=[]");
    }
    return set;
}

struct Fit
{
    std::vector<std::string> set;
    Real finest = 0, cost = 0;
};

/// The coarsest grid of the case whose finest cell is at most `finest`: the case's own cell times 4, 2, 1, 1/2, 1/3,
/// ..., so that planes and bodies that fitted its lattice still do.
/// @param counted  grids that were counted before, by grid_sections: methods share them
std::optional<Fit> fitting_grid(const AdviceRequest& request, const solver::Problem& problem, const ChartRow& method,
                                Real finest, std::map<std::string, ParticleCount>& counted)
{
    const Real several = method.levels > 1 ? std::pow(Real(2), problem.grid.levels - 1) : 1;
    constexpr int finest_part = 64;
    std::vector<Real> parts{4, 2, 1};
    for (int k = 2; k <= finest_part; ++k) parts.push_back(Real(1) / static_cast<Real>(k));
    for (const Real part : parts) {
        const Real cell = problem.grid.cell * part;
        if (cell / several > finest * (1 + 1e-6)) continue;
        if (refine::cells_around(solver::scene_of(problem).bodies, cell) > most_cells) return {};
        Fit fit{method_overrides(method, cell, problem), cell / several, 0};
        std::vector<std::string> overrides = request.overrides;
        overrides.insert(overrides.end(), fit.set.begin(), fit.set.end());
        try {
            const io::Case fitted = io::read_case_with_warnings(request.file, overrides);
            const auto [count, is_new] = counted.try_emplace(grid_sections(fitted.resolved));
            if (is_new) count->second = count_particles(fitted.problem);
            const Forecast f = forecast(fitted.problem, count->second);
            fit.cost = f.particle_steps;
            return fit;
        } catch (const core::InputError&) {
            continue; // such as a symmetry plane between the nodes of a coarser lattice
        }
    }
    return {};
}

/// Largest error of the rows at a resolution, the nearest coarser one measured, or extrapolated from the finest.
Real error_at(const Group& group, Real resolution, const std::optional<Real>& order)
{
    const ChartRow* nearest = nullptr;
    const ChartRow* finest = nullptr;
    for (const ChartRow* row : group) {
        if (!usable(*row)) continue;
        const Real x = row->finest_mm / row->length_mm;
        if (!finest || x < finest->finest_mm / finest->length_mm) finest = row;
        if (x >= resolution * (1 - 1e-6) && (!nearest || x < nearest->finest_mm / nearest->length_mm)) nearest = row;
    }
    if (!finest) return ChartRow::none;
    if (finest == nearest && order) {
        const Real p = std::clamp(*order, least_order, most_order);
        return finest->error * std::pow(resolution * finest->length_mm / finest->finest_mm, p);
    }
    return (nearest ? nearest : finest)->error;
}

bool own_case(const ChartRow& row, const std::filesystem::path& file)
{
    std::error_code ignored;
    return std::filesystem::equivalent(row.file, file, ignored);
}

/// Rows of the scenes to learn from: the case's own if it was charted, else the likest, at least three scenes if there
/// are.
std::vector<const ChartRow*> like_rows(const AdviceRequest& request, const SceneFeatures& features,
                                       const std::vector<ChartRow>& rows, bool& own)
{
    std::vector<const ChartRow*> known;
    for (const ChartRow& row : rows)
        if (std::find(request.without.begin(), request.without.end(), row.scene) == request.without.end())
            known.push_back(&row);
    std::vector<const ChartRow*> chosen;
    for (const ChartRow* row : known)
        if (own_case(*row, request.file)) chosen.push_back(row);
    own = !chosen.empty();
    if (own) return chosen;
    constexpr std::size_t enough = 3;
    for (int reach = 0; reach <= 3 * far; ++reach) {
        std::vector<std::string> scenes;
        chosen.clear();
        for (const ChartRow* row : known)
            if (feature_distance(features, *row) <= reach) {
                chosen.push_back(row);
                if (std::find(scenes.begin(), scenes.end(), row->scene) == scenes.end()) scenes.push_back(row->scene);
            }
        if (scenes.size() >= enough) break;
    }
    return chosen;
}

bool reached_by_any(const std::vector<Candidate>& candidates, const std::string& scene, Real error)
{
    return std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& candidate) {
        const auto group = candidate.scenes.find(scene);
        return group != candidate.scenes.end() && evidence_of(group->second, error).has_value();
    });
}

std::string sureness(const Advice& advice)
{
    std::size_t measured = 0, like = 0;
    for (const Evidence& one : advice.evidence) {
        measured += one.measured;
        like += one.distance < far;
    }
    const std::size_t n = advice.evidence.size();
    if (advice.own_scene)
        return measured == n ? "measured on this very case" : "extrapolated from runs of this very case";
    const char* word = like < n || measured == 0 ? "low" : n >= 3 && measured == n ? "high" : n >= 2 ? "fair" : "low";
    return fmt::format("{}: {} charted scene{} of like features, on {} of them this was measured, on {} extrapolated",
                       word, n, n == 1 ? "" : "s", measured, n - measured);
}
} // namespace

int feature_distance(const SceneFeatures& a, const ChartRow& b)
{
    const auto differ = [](bool mine, Real theirs) { return mine != (theirs > 0) ? 1 : 0; };
    return far * (differ(a.contact, b.contact) + differ(a.large_motion, b.large_motion)) +
           2 * differ(a.crack, b.crack) + differ(a.plastic, b.plastic) + differ(a.localised, b.localised);
}

std::optional<Evidence> evidence_of(const std::vector<const ChartRow*>& rows, Real error)
{
    std::vector<const ChartRow*> fine = rows; // from fine to coarse
    std::sort(fine.begin(), fine.end(),
              [](const ChartRow* a, const ChartRow* b) { return a->finest_mm < b->finest_mm; });
    std::erase_if(fine, [](const ChartRow* row) { return row->status == "over limit"; }); // too dear to know
    if (fine.empty() || !usable(*fine.front())) return {};
    Evidence evidence;
    evidence.scene = fine.front()->scene;
    std::vector<Real> h, e;
    for (const ChartRow* row : fine)
        if (usable(*row) && row->error > 0) h.push_back(row->finest_mm), e.push_back(row->error);
    evidence.order = fitted_order(h, e);
    for (const ChartRow* row : fine) {
        if (!usable(*row) || row->error > error) break;
        evidence.measured = true;
        evidence.resolution = row->finest_mm / row->length_mm;
    }
    if (evidence.measured) return evidence;
    if (!evidence.order || *evidence.order < least_order) return {};
    const ChartRow& finest = *fine.front();
    evidence.resolution =
        finest.finest_mm / finest.length_mm * std::pow(error / finest.error, 1 / std::min(*evidence.order, most_order));
    return evidence;
}

Advised advise(const AdviceRequest& request, const std::vector<ChartRow>& rows)
{
    const solver::Problem problem = io::read_case(request.file, request.overrides);
    const SceneFeatures features = features_of(problem, request);
    bool own = false;
    const std::vector<const ChartRow*> like = like_rows(request, features, rows, own);
    std::vector<std::string> scenes;
    for (const ChartRow* row : like)
        if (std::find(scenes.begin(), scenes.end(), row->scene) == scenes.end()) scenes.push_back(row->scene);
    const std::vector<Candidate> all = candidates(like);
    std::vector<std::string> silent;
    for (const std::string& scene : scenes)
        if (!reached_by_any(all, scene, request.error)) silent.push_back(scene);
    Advised advised;
    advised.length_mm = features.length;
    std::optional<Advice>& best = advised.advice;
    std::map<std::string, ParticleCount> counted;
    for (const Candidate& candidate : all) {
        if (candidate.method->levels > 1 && problem.grid.levels < 2) continue; // the case has no zones
        Advice advice;
        advice.method = *candidate.method;
        advice.own_scene = own;
        advice.resolution = std::numeric_limits<Real>::infinity();
        bool fails = false;
        for (const auto& [scene, group] : candidate.scenes) {
            if (std::find(silent.begin(), silent.end(), scene) != silent.end()) continue;
            std::optional<Evidence> one = evidence_of(group, request.error);
            fails = fails || !one;
            if (!one) break;
            one->distance = feature_distance(features, *group.front());
            advice.resolution = std::min(advice.resolution, one->resolution);
            advice.evidence.push_back(*one);
        }
        // A method must have proved itself on most of the scenes, or its few would count for more than the many of
        // others.
        if (fails || advice.evidence.empty() || 2 * advice.evidence.size() < scenes.size() - silent.size()) continue;
        advice.silent = silent;
        const std::optional<Fit> fit =
            fitting_grid(request, problem, *candidate.method, advice.resolution * features.length, counted);
        if (!fit) {
            advised.asked_mm = std::max(advised.asked_mm, advice.resolution * features.length);
            continue;
        }
        advice.set = fit->set;
        advice.finest_mm = fit->finest;
        advice.resolution = fit->finest / features.length;
        advice.cpu_s = fit->cost * step_cost(candidate);
        for (const Evidence& one : advice.evidence)
            advice.charted_error =
                std::max(advice.charted_error, error_at(candidate.scenes.at(one.scene), advice.resolution, one.order));
        if (!best || advice.cpu_s < best->cpu_s) best = std::move(advice);
    }
    return advised;
}

std::string advice_text(const AdviceRequest& request, const Advice& advice)
{
    const solver::Problem problem = io::read_case(request.file, request.overrides);
    const SceneFeatures features = features_of(problem, request);
    const ChartRow& m = advice.method;
    std::string text =
        fmt::format("# For {} with an error of at most {:.3g} %\n", request.file.generic_string(), 100 * request.error);
    text += fmt::format("# scene: {}; {:.4g} mm to be resolved\n", features_text(features), features.length);
    text += fmt::format("# {:.3g} cells across it: every scene below met the error with this method there\n",
                        1 / advice.resolution);
    for (const Evidence& one : advice.evidence)
        text += fmt::format("#   {:<24} needs {:.3g} cells, {}{}\n", one.scene, 1 / one.resolution,
                            one.measured ? "measured" : "extrapolated",
                            one.order ? fmt::format(", error ~ h^{:.1f}", *one.order) : "");
    for (const std::string& scene : advice.silent)
        text += fmt::format("#   {:<24} left out: no charted method comes that near its reference\n", scene);
    text += fmt::format("# largest error of these scenes at this resolution: {:.2g} %\n", 100 * advice.charted_error);
    text += fmt::format("# expected cost: {:.3g} s of processor time, the least of the charted methods that do\n",
                        advice.cpu_s);
    text += fmt::format("# sure? {}\n\n", sureness(advice));
    const bool several = m.levels > 1;
    const Real cell = several ? advice.finest_mm * std::pow(Real(2), problem.grid.levels - 1) : advice.finest_mm;
    text += fmt::format(
        "[grid]\ncell = {}\nlevels = {}{}\nparticles_per_cell = {}\n\n", cell, several ? problem.grid.levels : 1,
        !several && problem.grid.levels > 1 ? " # and no [[refine.zone]]" : "", std::lround(m.particles_per_cell));
    text += fmt::format("[numerics]\nformulation = \"{}\"\nbasis = \"{}\"\ntransfer = \"{}\"\nstress_update = \"{}\"\n"
                        "precision = \"{}\"\npic_fraction = {}\ncfl = {}\n",
                        m.formulation, m.basis, m.transfer, m.stress_update, m.precision, m.pic_fraction, m.cfl);
    return text;
}
} // namespace app
