#include "app/progress.h"

#include "io/atomic_file.h"
#include "tests/io/file_faults.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

namespace
{
app::Status example()
{
    app::Status status;
    status.clock = {41200, 0.504, 1.22e-5};
    status.last.force_upper = 7910;
    status.last.cod = 2.31;
    status.last.energy = {.kinetic = 0.3, .elastic = 40, .plastic = 50, .decohesion = 10};
    status.last.particles = {1100000, 85000};
    status.done = 41200.0 / 98000;
    status.seconds_left = 2830;
    status.particle_steps_per_s = 38e6;
    status.resident_bytes = 2900000000;
    return status;
}
} // namespace

TEST(StatusLine, ShowsWhatTheDesignAsksFor)
{
    EXPECT_EQ(app::status_line(example()),
              "step 41 200/98 000  t 0.504 ms (42 %)  dt 1.22e-05  F 7.91 kN  COD 2.31 mm  KE/IE 0.3 %  L0 1.1M L1 85k"
              "  38 Mp/s  ETA 0:47:10  RSS 2.9 GB");
}

TEST(StatusLine, LeavesOutWhatIsNotKnown)
{
    app::Status status = example();
    status.done.reset();
    status.seconds_left.reset();
    status.last.energy = {};
    EXPECT_EQ(app::status_line(status), "step 41 200  t 0.504 ms  dt 1.22e-05  F 7.91 kN  COD 2.31 mm  L0 1.1M L1 85k"
                                        "  38 Mp/s  RSS 2.9 GB");
}

TEST(ShareDone, IsThatOfTheEndWhichComesFirst)
{
    solver::End end;
    EXPECT_FALSE(app::share_done(end, 1, 1).has_value());
    end.time = 4;
    EXPECT_EQ(app::share_done(end, 1, 1), 0.25);
    end.cod = 2;
    EXPECT_EQ(app::share_done(end, 1, 1), 0.5);
    EXPECT_EQ(app::share_done(end, 9, 1), 1);
}

TEST(Progress, WritesAPlainLineEvery30SecondsWithSpeedAndTimeLeft)
{
    const support::Folder folder;
    std::FILE* out = std::fopen((folder.path() / "out").c_str(), "w");
    double now = 1000;
    {
        app::Log log(folder.path() / "log.txt", out, false);
        app::Progress progress({.time = 1}, log, [&] { return now; });
        solver::HistoryLine last;
        last.particles = {500};
        solver::Clock clock{0, 0.5, 0.001}; // resumed half way
        for (int step = 1; step <= 100; ++step) {
            now += 1;
            clock.step = step;
            clock.time = 0.5 + 0.001 * step;
            progress.after_step(clock, last, 6000000);
        }
    }
    std::fclose(out);
    const std::string text = io::read_file(folder.path() / "out");
    EXPECT_EQ(text, io::read_file(folder.path() / "log.txt"));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3); // at 30, 60 and 90 s
    EXPECT_PRED2(faults::contains, text, "step 30/");
    std::size_t lines_with_speed = 0; // every line counts the steps since the one before
    for (std::size_t at = text.find("  6 Mp/s"); at != text.npos; at = text.find("  6 Mp/s", at + 1))
        ++lines_with_speed;
    EXPECT_EQ(lines_with_speed, 3u);
    // At 90 s the share done went from 0.501 to 0.59: 410/89 of 90 s are left.
    EXPECT_PRED2(faults::contains, text, "ETA 0:06:55");
}

TEST(Progress, RefreshesATerminalTwiceASecondAndTheLogRarely)
{
    const support::Folder folder;
    std::FILE* out = std::fopen((folder.path() / "out").c_str(), "w");
    double now = 0;
    {
        app::Log log(folder.path() / "log.txt", out, true);
        app::Progress progress({.time = 1}, log, [&] { return now; });
        for (int step = 1; step <= 400; ++step) {
            now = 0.1 * step;
            progress.after_step({step, 0.001 * step, 0.001}, {}, 10);
        }
    }
    std::fclose(out);
    const std::string shown = io::read_file(folder.path() / "out"), logged = io::read_file(folder.path() / "log.txt");
    EXPECT_NEAR(static_cast<double>(std::count(shown.begin(), shown.end(), '\r')), 75, 8);
    EXPECT_EQ(std::count(logged.begin(), logged.end(), '\n'), 1);
}
