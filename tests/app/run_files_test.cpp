#include "app/run_files.h"

#include "core/error.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

#include <fstream>

namespace fs = std::filesystem;

namespace
{
/// Works in a folder of its own, as a user of the default directory does.
class ResultDirectory : public testing::Test
{
protected:
    ResultDirectory() { fs::current_path(folder_.path()); }
    ~ResultDirectory() override { fs::current_path(before_); }

private:
    fs::path before_ = fs::current_path();
    support::Folder folder_;
};

app::RunOptions of_case(const std::string& file)
{
    app::RunOptions options;
    options.file = file;
    return options;
}
} // namespace

// Asked for before any of the runs has written a file.
TEST_F(ResultDirectory, runs_started_together_have_one_each)
{
    EXPECT_EQ(app::result_directory(of_case("bar.toml")), fs::path("results/bar"));
    EXPECT_EQ(app::result_directory(of_case("bar.toml")), fs::path("results/bar-2"));
    EXPECT_EQ(app::result_directory(of_case("bar.toml")), fs::path("results/bar-3"));
    app::RunOptions again = of_case("bar.toml");
    again.force = true;
    EXPECT_EQ(app::result_directory(again), fs::path("results/bar"));
}

TEST_F(ResultDirectory, a_named_one_that_holds_a_run_is_refused)
{
    app::RunOptions options = of_case("bar.toml");
    options.directory = "deep/out";
    EXPECT_EQ(app::result_directory(options), fs::path("deep/out"));
    EXPECT_TRUE(fs::is_directory("deep/out"));
    EXPECT_EQ(app::result_directory(options), fs::path("deep/out")); // no run in it yet
    std::ofstream("deep/out/run.json") << "{}";
    EXPECT_THROW(app::result_directory(options), core::InputError);
    options.resume = true;
    EXPECT_EQ(app::result_directory(options), fs::path("deep/out"));
}
