#include "app/sweep_table.h"

#include <gtest/gtest.h>

TEST(SlurmScript, a_title_of_several_lines_stays_a_comment)
{
    io::Sweep sweep;
    sweep.title = "two\nrm -rf lines";
    sweep.file = "case.toml";
    app::StudyRun run;
    run.label = "a";
    run.file = "/cases/case.toml";
    run.directory = "/nowhere/runs/a";
    const std::string script = app::slurm_script(sweep, {run}, "/bin/cleave");
    EXPECT_NE(script.find("\n# two rm -rf lines: 1 runs of case.toml."), std::string::npos) << script;
    EXPECT_NE(script.find("\n0) set -- 'run' '/cases/case.toml' '-o' '/nowhere/runs/a'"), std::string::npos) << script;
}
