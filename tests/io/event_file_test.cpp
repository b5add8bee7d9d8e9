#include "io/event_file.h"

#include "io/atomic_file.h"
#include "tests/io/sample_state.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

TEST(EventFile, names_ligaments_and_initiations_and_reads_back)
{
    solver::Problem problem;
    problem.ligaments = {{"A", "D", {}, 2}};
    problem.start_features = {"A"};
    const solver::State state = sample::state();
    const std::string text = io::events_text(problem, state);
    EXPECT_EQ(text, "step,time_ms,ligament,event,front,force_N,cod_mm,initiation\n"
                    "100,0.1,A-D,onset,0,2000,0.3,\n"
                    "400,0.4,A-D,first,0.3333,5000,0.6,c1\n");
    const support::Folder folder;
    io::write_file(folder.path() / "events.csv", text);
    const auto rows = io::read_events(folder.path() / "events.csv");
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[2], (std::vector<std::string>{"400", "0.4", "A-D", "first", "0.3333", "5000", "0.6", "c1"}));
    EXPECT_EQ(rows[1].back(), "");
}
