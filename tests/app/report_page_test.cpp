#include "app/report_page.h"

#include "app/commands.h"
#include "app/exit_code.h"
#include "io/atomic_file.h"
#include "io/case.h"
#include "io/history_file.h"
#include "tests/io/file_faults.h"
#include "tests/io/sample_state.h"
#include "tests/support/folder.h"

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include <limits>

namespace
{
using faults::contains;

app::Report sample_report()
{
    app::Report report;
    report.record.title = "Plate <1>";
    report.record.status = "done";
    report.record.modelled = {"symmetry: z = 30 halves the work"};
    report.record.measures = {{"peak_force_N", 8200.0},
                              {"c1_force_N", std::numeric_limits<Real>::quiet_NaN()},
                              {"crack_path", std::string("A-D-C-E")}};
    report.record.references = {
        {"experiment", {{"peak_force_N", 8000.0}, {"c1_force_N", 7000.0}, {"c1_cod_mm", 0.4}}, "A-C-E"}};
    report.problem.ligaments = {{"A", "D", {}}};
    report.problem.force_upper = "grip";
    report.problem.symmetry = {{2, 30}};
    report.problem.zones.push_back({"path A-D", {}, 1, 0.5});
    report.resolved = "units = \"mm-g-ms\"\n";
    report.events = {{"step", "ligament", "event"}, {"400", "A-D", "first"}};
    const solver::State state = sample::state();
    report.history = state.history;
    io::ParticleFrame& frame = report.frame.emplace();
    for (std::size_t p = 0; p < state.particles.size(); ++p) {
        for (std::size_t a = 0; a < 3; ++a)
            frame.position[a].push_back(static_cast<float>(state.particles.position[a][p]));
        frame.side.push_back(state.particles.size_level[p] == 0 ? 0.125f : 0.0625f);
        frame.scalar["damage"].push_back(p % 10 == 0 ? 1.0f : 0.0f);
    }
    return report;
}
} // namespace

TEST(ReportPage, HoldsCurveMeasuresPicturesZonesAndVersions)
{
    const std::string page = app::report_page(sample_report());
    EXPECT_PRED2(contains, page, "<h1>Plate &lt;1&gt;</h1>");
    EXPECT_PRED2(contains, page, "<td>peak_force_N</td><td>8200</td><td>8000 (+2.5 %)</td>");
    EXPECT_PRED2(contains, page, "<td>c1_force_N</td><td>not reached</td><td>7000</td>");
    EXPECT_PRED2(contains, page, "<td>crack_path</td><td>A-D-C-E</td><td>A-C-E</td>");
    EXPECT_PRED2(contains, page, ">c1</text>");       // the point of the reference
    EXPECT_PRED2(contains, page, "experiment, peak"); // its line
    EXPECT_PRED2(contains, page, "<tr><td>400</td><td>A-D</td><td>first</td></tr>");
    EXPECT_PRED2(contains, page, "full specimen: 2 times");
    EXPECT_PRED2(contains, page, "damage at t =");
    EXPECT_PRED2(contains, page, "do not hold eq_plastic_strain");
    EXPECT_PRED2(contains, page, "<td>path A-D</td><td>1</td><td>0.5</td>");
    EXPECT_PRED2(contains, page, "symmetry: z = 30 halves the work");
    EXPECT_PRED2(contains, page, "units = &quot;mm-g-ms&quot;");
    EXPECT_FALSE(contains(page, "src=")); // no other file is needed
    EXPECT_FALSE(contains(page, "href="));
}

TEST(ReportPage, SurvivesARunThatHasJustBegun)
{
    app::Report report = sample_report();
    report.history.clear();
    report.frame.reset();
    report.record.measures.clear();
    EXPECT_PRED2(contains, app::report_page(report), "no particle file");
}

TEST(Report, ReadsAResultDirectory)
{
    const support::Folder folder;
    const solver::State state = sample::state();
    io::write_run_record(folder.path() / "run.json", sample_report().record);
    const io::HistoryFile history(folder.path() / "history.csv", 2, state.history);
    io::write_particle_frame(folder.path() / "particles", state.particles, state.levels, state.clock,
                             {.fields = {"damage", "eq_plastic_strain"}, .version = "0.1.0"});
    io::write_file(
        folder.path() / "resolved.toml",
        io::read_case_with_warnings(std::filesystem::path(CLEAVE_SOURCE_DIR) / "cases/snl/preview.toml").resolved);

    CLI::App program;
    app::Command chosen;
    app::add_report(program, chosen);
    app::add_metric(program, chosen);
    program.parse("report " + folder.path().string());
    EXPECT_EQ(app::run_reporting_errors(chosen), app::exit_done);
    const std::string page = io::read_file(folder.path() / "report.html");
    EXPECT_PRED2(contains, page, "eq_plastic_strain at t =");
    EXPECT_PRED2(contains, page, "experiment");

    program.parse("metric " + (folder.path() / "nothing").string());
    EXPECT_EQ(app::run_reporting_errors(chosen), app::exit_file);
}
