#include "app/chart.h"

#include "app/advise.h"
#include "app/chart_page.h"
#include "app/chart_summary.h"
#include "app/leave_one_out.h"
#include "app/scene_features.h"
#include "app/source_tree.h"
#include "core/error.h"
#include "io/case.h"
#include "tests/support/folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace
{
using io::ChartRow;

ChartRow row(const std::string& scheme, Real h, Real error, Real cpu)
{
    ChartRow r;
    r.scene = "scene";
    r.scheme = r.setting = scheme;
    r.role = scheme == "default" ? "scheme" : "";
    r.status = "done";
    r.finest_mm = r.cell_mm = h;
    r.levels = 1;
    r.error = error;
    r.cpu_s = cpu;
    r.length_mm = 10;
    r.particle_steps = cpu * 1e7;
    r.particles_per_cell = 8;
    r.pic_fraction = 0;
    r.cfl = 0.5;
    r.formulation = "total";
    r.basis = "trilinear";
    r.transfer = scheme == "flip" ? "flip" : "nodal";
    r.stress_update = "usl";
    r.precision = "f64";
    return r;
}

TEST(Chart, front_holds_what_nothing_beats_in_both)
{
    std::vector<ChartRow> rows{row("a", 1, 0.1, 1), row("a", 1, 0.05, 4), row("a", 1, 0.06, 8), row("a", 1, 0.2, 2),
                               row("a", 1, 0.001, 0.1)};
    rows[4].status = "unstable"; // the best numbers, but not to be had
    app::mark_fronts(rows);
    EXPECT_EQ(rows[0].front, 1);
    EXPECT_EQ(rows[1].front, 1);
    EXPECT_EQ(rows[2].front, 0);
    EXPECT_EQ(rows[2].cost_over_front, 2); // 4 s would do
    EXPECT_EQ(rows[3].cost_over_front, 2);
    EXPECT_EQ(rows[4].front, 0);
    EXPECT_TRUE(std::isnan(rows[4].cost_over_front));
}

TEST(Chart, fronts_do_not_mix_scenes)
{
    std::vector<ChartRow> rows{row("a", 1, 0.1, 1), row("a", 1, 0.2, 2)};
    rows[1].scene = "other";
    app::mark_fronts(rows);
    EXPECT_EQ(rows[1].front, 1);
}

/// What plan_chart says of a scene with these results.
std::string plan_complaint(const std::string& measure, const std::string& stability);

TEST(Chart, a_result_that_no_run_has_is_told_before_the_runs)
{
    EXPECT_EQ(plan_complaint("measures.peak_force_N", "measures.energy_residual"), "");
    EXPECT_EQ(plan_complaint("cpu_s", "wall_s"), ""); // of run.json itself
    const std::string wrong = plan_complaint("measures.peak_farce_N", "measures.energy_residual");
    EXPECT_TRUE(wrong.starts_with("scene 'cube': its runs have no number 'measures.peak_farce_N'; did you mean "
                                  "'measures.peak_force_N'?\nnumbers: measures.peak_force_N, "))
        << wrong;
    EXPECT_NE(plan_complaint("measures.peak_force_N", "errors.energy_residual").find("no number 'errors.energy"),
              std::string::npos);
}

TEST(ChartTable, cases_of_the_source_tree_are_found_from_anywhere)
{
    const std::filesystem::path file = "cases/chart/quick.toml", before = std::filesystem::current_path();
    if (!app::source_file(file)) GTEST_SKIP() << "built outside of the source tree";
    const support::Folder folder;
    std::filesystem::current_path(folder.path());
    const std::filesystem::path found = app::here_or_source(file);
    EXPECT_TRUE(std::filesystem::exists(found)) << found;
    EXPECT_EQ(app::here_or_source("no/such/case.toml"), std::filesystem::path("no/such/case.toml"));
    std::filesystem::current_path(before);
}

TEST(ChartSummary, order_is_the_slope)
{
    EXPECT_NEAR(*app::fitted_order({1, 0.5, 0.25}, {0.16, 0.04, 0.01}), 2, 1e-12);
    EXPECT_FALSE(app::fitted_order({1, 1}, {0.1, 0.2}));
    EXPECT_FALSE(app::fitted_order({1}, {0.1}));
}

TEST(ChartSummary, several_levels_against_one_at_equal_error)
{
    // One level: error 1/cost. Two levels: the error of cost 10 for 2.
    std::vector<ChartRow> rows{row("default", 1, 0.1, 10), row("default", 0.5, 0.01, 100),
                               row("default", 0.5, 0.03, 2)};
    rows[2].levels = 2;
    bool beyond = false;
    EXPECT_NEAR(*app::two_level_factor(rows, beyond), (1 / 0.03) / 2, 1e-9);
    EXPECT_FALSE(beyond);
    rows[2].error = 0.001;
    EXPECT_FALSE(app::two_level_factor(rows, beyond));
    EXPECT_TRUE(beyond);
    rows[2].error = 0.03;
    rows[2].transfer = "flip"; // another method: not to be compared
    EXPECT_FALSE(app::two_level_factor(rows, beyond));
    rows[2].transfer = rows[0].transfer;
    rows[2].scheme = "dilatation at the points"; // nor another law
    EXPECT_FALSE(app::two_level_factor(rows, beyond));
}

TEST(ChartSummary, counts_crosses_apart_from_what_does_not_apply)
{
    std::vector<ChartRow> rows(4, row("default", 1, 0.1, 10));
    rows[0].role = "default";
    rows[1].status = "failed";
    rows[2].status = "over limit";
    rows[3].status = "not applicable";
    app::mark_fronts(rows);
    const std::vector<app::SceneSummary> all = app::summarise(rows);
    ASSERT_EQ(all.size(), 1U);
    EXPECT_EQ(all[0].settings, 3U);
    EXPECT_EQ(all[0].crosses, 2U);
    EXPECT_EQ(all[0].not_applicable, 1U);
    EXPECT_EQ(all[0].default_over_front, 1);
}

TEST(ChartPage, shows_every_run_and_escapes)
{
    std::vector<ChartRow> rows{row("a<b", 1, 0.1, 1), row("bad", 1, NAN, 2)};
    rows[1].status = "failed";
    rows[1].reason = "particle 7 has no finite motion";
    app::mark_fronts(rows);
    const std::string page = app::chart_page("t", rows, {{"scene", "A bar"}}, {{"scene", "<svg>picture</svg>"}});
    for (const char* part : {"a&lt;b", "particle 7 has no finite motion", "<h2>A bar</h2>", "<svg>picture</svg>"})
        EXPECT_NE(page.find(part), std::string::npos) << part;
}

std::vector<const ChartRow*> pointers(const std::vector<ChartRow>& rows)
{
    std::vector<const ChartRow*> all;
    for (const ChartRow& r : rows) all.push_back(&r);
    return all;
}

TEST(SceneFeatures, a_crack_model_without_strength_is_none)
{
    solver::Problem problem;
    problem.materials.emplace_back().decohesion.emplace();
    material::Decohesion& law = *problem.materials[0].decohesion;
    law.s_max = law.tau_max = std::numeric_limits<Real>::infinity();
    EXPECT_FALSE(app::scene_features(problem).crack);
    law.tau_max = 820;
    EXPECT_TRUE(app::scene_features(problem).crack);
}

TEST(Advise, evidence_is_the_coarsest_measured_cell_from_which_on_all_met)
{
    // 0.5 met by luck, 0.25 did not, 0.125 did: luck is not trusted.
    const std::vector<ChartRow> rows{row("a", 1, 0.1, 1), row("a", 0.5, 0.005, 1), row("a", 0.25, 0.02, 1),
                                     row("a", 0.125, 0.006, 1)};
    const std::optional<app::Evidence> found = app::evidence_of(pointers(rows), 0.01);
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->measured);
    EXPECT_DOUBLE_EQ(found->resolution, 0.0125);
}

TEST(Advise, evidence_is_extrapolated_with_the_fitted_order)
{
    const std::vector<ChartRow> rows{row("a", 1, 0.2, 1), row("a", 0.5, 0.1, 1)};
    const std::optional<app::Evidence> found = app::evidence_of(pointers(rows), 0.025);
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->measured);
    EXPECT_NEAR(*found->order, 1, 1e-12);
    EXPECT_NEAR(found->resolution, 0.0125, 1e-12);
}

TEST(Advise, no_evidence_from_errors_that_do_not_fall_or_a_failed_finest_run)
{
    std::vector<ChartRow> rows{row("a", 1, 0.1, 1), row("a", 0.5, 0.11, 1)};
    EXPECT_FALSE(app::evidence_of(pointers(rows), 0.01));
    rows[1].error = 0.001;
    EXPECT_TRUE(app::evidence_of(pointers(rows), 0.01));
    rows[1].status = "unstable";
    EXPECT_FALSE(app::evidence_of(pointers(rows), 0.5));
}

/// A cube of steel with a hole, pulled: elastic, one level.
std::filesystem::path written_case(const support::Folder& folder)
{
    const std::filesystem::path file = folder / "cube.toml";
    std::ofstream(file) << R"(units = "mm-g-ms"
[grid]
cell = 1
[material.steel]
density = 7.81e-3
youngs_modulus = 195e3
poisson_ratio = 0.3
[feature.hole]
centre = [5, 5, 0]
diameter = 4
[[body]]
material = "steel"
shape = { difference = { from = { box = { lower = [0, 0, 0], upper = [10, 10, 1] } }, holes = [{ feature = "hole" }] } }
[[symmetry]]
axis = "z"
[load.top]
region = { box = { lower = [-inf, 9, -inf], upper = [inf, inf, inf] } }
velocity = 1
axis = "y"
[end]
time = 0.01
)";
    return file;
}

std::string plan_complaint(const std::string& measure, const std::string& stability)
{
    const support::Folder folder;
    io::Scene scene;
    scene.name = "cube";
    scene.file = written_case(folder);
    scene.measure = measure;
    scene.stable = {stability, 0.1};
    io::Suite suite;
    suite.scenes.push_back(scene);
    try {
        (void)app::plan_chart(suite, folder / "out");
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "";
}

/// Three scenes alike (elastic with a hole) on which `nodal` has error (h/L)^1 and flip half of it at four times the
/// cost.
std::vector<ChartRow> measured()
{
    std::vector<ChartRow> rows;
    for (const char* scene : {"one", "two", "three"})
        for (const char* scheme : {"nodal", "flip"})
            for (const Real h : {1.0, 0.5, 0.25}) {
                const bool flip = std::string(scheme) == "flip";
                ChartRow& r = rows.emplace_back(row(scheme, h, h / 10 / (flip ? 2 : 1), 1 / (h * h * h * h)));
                r.scene = scene;
                r.localised = 1;
                r.particle_steps = r.cpu_s * (flip ? 1e7 : 4e7);
            }
    return rows;
}

TEST(Advise, takes_the_cheapest_method_that_like_scenes_met_the_error_with)
{
    const support::Folder folder;
    const app::AdviceRequest request{written_case(folder), {}, 0.05, {}, {}};
    const std::optional<app::Advice> advice = app::advise(request, measured()).advice;
    ASSERT_TRUE(advice);
    // nodal needs x = 0.05: 0.2 mm in the hole of 4 mm. flip needs x = 0.1 and a cell of 1/3 mm: at (3/5)^4 of the
    // particle-steps, four times as dear each, it costs 0.52 of nodal.
    EXPECT_EQ(advice->method.transfer, "flip");
    EXPECT_NEAR(advice->finest_mm, 1.0 / 3, 1e-6);
    EXPECT_EQ(advice->evidence.size(), 3U);
    const std::string text = app::advice_text(request, *advice);
    for (const char* part : {"transfer = \"flip\"", "localised feature", "sure? high", "needs 10 cells, measured"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
}

TEST(Advise, a_method_that_failed_on_a_like_scene_is_not_advised)
{
    const support::Folder folder;
    std::vector<ChartRow> rows = measured();
    for (ChartRow& r : rows)
        if (r.scene == "two" && r.scheme == "flip" && r.finest_mm == 0.25) r.status = "failed";
    const std::optional<app::Advice> advice = app::advise({written_case(folder), {}, 0.05, {}, {}}, rows).advice;
    ASSERT_TRUE(advice);
    EXPECT_EQ(advice->method.transfer, "nodal");
}

/// A reference that is off by more than the wanted error tells no method from another.
TEST(Advise, a_like_scene_that_nothing_comes_near_is_left_out_and_named)
{
    const support::Folder folder;
    std::vector<ChartRow> rows = measured();
    for (ChartRow& r : rows)
        if (r.scene == "two") r.error = 0.1; // converges to something else
    const app::AdviceRequest request{written_case(folder), {}, 0.05, {}, {}};
    const std::optional<app::Advice> advice = app::advise(request, rows).advice;
    ASSERT_TRUE(advice);
    EXPECT_EQ(advice->evidence.size(), 2U);
    EXPECT_EQ(advice->silent, std::vector<std::string>{"two"});
    const std::string text = app::advice_text(request, *advice);
    for (const char* part : {"two                      left out", "sure? fair"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
}

TEST(Advise, out_of_reach_is_no_advice)
{
    const support::Folder folder;
    std::vector<ChartRow> rows = measured();
    for (ChartRow& r : rows) r.error = 0.1; // nothing converges
    const app::Advised advised = app::advise({written_case(folder), {}, 0.05, {}, {}}, rows);
    EXPECT_FALSE(advised.advice);
    EXPECT_EQ(advised.asked_mm, 0);
}

TEST(Advise, a_grid_too_large_is_no_advice_but_its_cell_is_told)
{
    const support::Folder folder;
    const app::Advised advised = app::advise({written_case(folder), {}, 0.05, 0.1, {}}, measured());
    EXPECT_FALSE(advised.advice);
    EXPECT_NEAR(advised.asked_mm, 0.01, 1e-12); // flip with ten cells across 0.1 mm
    EXPECT_EQ(advised.length_mm, 0.1);
}

/// A slot made of overlapping pieces is no narrower than where its pieces meet.
TEST(SceneFeatures, a_piece_of_a_slot_is_no_hole_of_its_own)
{
    const support::Folder folder;
    const auto length = [&](const std::vector<std::string>& overrides) {
        return app::scene_features(io::read_case(written_case(folder), overrides)).length;
    };
    EXPECT_NEAR(length({}), 4, 1e-9);
    const std::string piece =
        "feature.piece={centre=[7,5,0],axis=\"z\",shape={box={lower=[6.8,3,-inf],upper=[7.2,7,inf]}}}";
    EXPECT_NEAR(length({piece}), 0.4, 1e-9);
    EXPECT_NEAR(
        length({piece, "feature.slot={centre=[5,5,0],axis=\"z\",shape={box={lower=[5,4,-inf],upper=[9,6,inf]}}}"}), 2,
        1e-9);
}

/// A block of 10 x 10 x 3 mm without a void along z, which is a feature.
solver::Problem block_with(const geometry::Shape& hollow, const Vec3& centre)
{
    solver::Problem problem;
    problem.grid.cell = 0.5;
    problem.bodies = {{"block", geometry::subtract(geometry::box({0, 0, 0}, {10, 10, 3}), {hollow}), 0, Vec3::Zero()}};
    problem.features = {{"void", hollow, centre}};
    return problem;
}

geometry::Shape round_hole(Real x, Real y)
{
    return geometry::cylinder({x, y, -9}, {x, y, 9}, 2);
}

TEST(SceneFeatures, what_rounds_a_corner_is_no_hole)
{
    const geometry::Shape rounding = geometry::subtract(geometry::box({8, 8, -9}, {11, 11, 9}), {round_hole(8, 8)});
    const app::SceneFeatures outer = app::scene_features(block_with(rounding, {9.8, 9.8, 1}));
    EXPECT_FALSE(outer.localised);
    EXPECT_NEAR(outer.length, 3, 1e-9);
    // A cylinder of 12 mm beside the metal makes the fillet between grip and parallel length.
    solver::Problem coupon = io::read_case(std::string(CLEAVE_SOURCE_DIR) + "/cases/tension/coupon.toml", {});
    ASSERT_EQ(coupon.features.size(), 1U);
    coupon.zones.clear();
    const app::SceneFeatures inner = app::scene_features(coupon);
    EXPECT_FALSE(inner.localised);
    EXPECT_NEAR(inner.length, 1.575, 1e-9);
}

TEST(SceneFeatures, holes_and_slots_are_between_metal)
{
    solver::Problem quarter = block_with(round_hole(0, 0), {0, 0, 0});
    quarter.symmetry = {{0, 0}, {1, 0}};
    const geometry::Shape slot = geometry::box({-1, 4, -9}, {4, 5.5, 9}); // open at the edge
    for (const auto& [problem, width] : {std::pair(block_with(round_hole(4, 5), {4, 5, 1}), 4.0),
                                         std::pair(quarter, 4.0), std::pair(block_with(slot, {2, 4.75, 1}), 1.5)})
    {
        const app::SceneFeatures features = app::scene_features(problem);
        EXPECT_TRUE(features.localised);
        EXPECT_NEAR(features.length, width, 1e-9);
    }
}

TEST(LeaveOneOut, tells_met_from_missed)
{
    const support::Folder folder;
    std::vector<ChartRow> rows = measured();
    for (ChartRow& r : rows) r.file = written_case(folder).string();
    // The file is the same for all, so every scene counts as the case's own; the left-out one must not.
    std::vector<app::Verdict> verdicts = app::leave_one_out(rows, 0.05);
    ASSERT_EQ(verdicts.size(), 3U);
    for (const app::Verdict& v : verdicts) EXPECT_EQ(v.kind, app::Verdict::Kind::met) << v.scene;
    for (ChartRow& r : rows)
        if (r.scene == "three" && r.scheme == "flip") r.error *= 3;
    verdicts = app::leave_one_out(rows, 0.05);
    EXPECT_EQ(verdicts[2].kind, app::Verdict::Kind::missed);
}
} // namespace
