#include "io/run_record.h"

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/process_memory.h"
#include "tests/io/file_faults.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>

namespace
{
io::RunRecord record()
{
    io::RunRecord record;
    record.title = "SFC1, \"mixed\" mode";
    record.version = "0.1.0";
    record.commit = "b149e1b2af";
    record.status = "done";
    record.exit_reason = "end.cod reached";
    record.compiler = "g++ 12.2.0";
    record.instruction_set = "x86-64-v4";
    record.threads = 2;
    record.wall_s = 12.5;
    record.cpu_s = 24.5;
    record.steps = 1000;
    record.particle_steps = 50000000;
    record.peak_rss_bytes = 3000000000;
    record.particles_start = {100, 200};
    record.particles_end = {90, 280};
    record.modelled = {"decohesion: the material has s_max"};
    record.measures = {{"peak_force_N", 8123.25},
                       {"c2_force_N", std::numeric_limits<Real>::quiet_NaN()},
                       {"crack_path", std::string("A-D-C-E")}};
    record.references = {{"experiment", {{"peak_force_N", 8000.0}}, "A-C-E"}};
    return record;
}
} // namespace

TEST(RunRecord, HasTheKeysOfTheContract)
{
    const support::Folder folder;
    io::write_run_record(folder.path() / "run.json", record());
    const auto json = nlohmann::json::parse(io::read_file(folder.path() / "run.json"));
    EXPECT_EQ(json.at("version"), "0.1.0");
    EXPECT_EQ(json.at("commit"), "b149e1b2af");
    EXPECT_EQ(io::read_run_record(folder.path() / "run.json").commit, "b149e1b2af");
    EXPECT_EQ(json.at("threads"), 2);
    EXPECT_EQ(json.at("wall_s"), 12.5);
    EXPECT_EQ(json.at("cpu_s"), 24.5);
    EXPECT_EQ(json.at("steps"), 1000);
    EXPECT_EQ(json.at("particle_steps"), 50000000);
    EXPECT_EQ(json.at("particle_steps_per_s"), 4e6);
    EXPECT_EQ(json.at("peak_rss_bytes"), 3000000000);
    EXPECT_EQ(json.at("particles").at("start"), (std::vector<int>{100, 200}));
    EXPECT_EQ(json.at("particles").at("end"), (std::vector<int>{90, 280}));
    EXPECT_EQ(json.at("modelled").at(0), "decohesion: the material has s_max");
    EXPECT_EQ(json.at("measures").at("peak_force_N"), 8123.25);
    EXPECT_TRUE(json.at("measures").at("c2_force_N").is_null());
    EXPECT_EQ(json.at("measures").at("crack_path"), "A-D-C-E");
}

TEST(RunRecord, ReadsBackAsItWas)
{
    const support::Folder folder;
    const auto path = folder.path() / "run.json";
    io::write_run_record(path, record());
    const std::string text = io::read_file(path);
    io::write_run_record(path, io::read_run_record(path));
    EXPECT_EQ(io::read_file(path), text);
    EXPECT_EQ(io::read_run_record(path).references.at(0).measure.at("peak_force_N"), 8000);
}

TEST(RunRecord, TakesEarlierOnesWithoutProcessorTime)
{
    const support::Folder folder;
    const auto path = folder.path() / "run.json";
    io::write_run_record(path, record());
    auto json = nlohmann::json::parse(io::read_file(path));
    json.erase("cpu_s");
    io::write_file(path, json.dump());
    EXPECT_EQ(io::read_run_record(path).cpu_s, 25);
}

TEST(RunRecord, GivesItsMeasuresOnOneLine)
{
    EXPECT_EQ(io::measures_line(record()), R"({"title":"SFC1, \"mixed\" mode","status":"done","peak_force_N":8123.25,)"
                                           R"("c2_force_N":null,"crack_path":"A-D-C-E"})");
}

TEST(RunRecord, NamesAFileItCannotRead)
{
    const support::Folder folder;
    const auto path = folder.path() / "run.json";
    EXPECT_THROW(io::read_run_record(path), core::FileError);
    io::write_file(path, "{\"title\": 3}");
    EXPECT_PRED2(faults::contains, faults::message<core::FileError>([&] { io::read_run_record(path); }), "run.json");
    io::write_file(path, "{");
    EXPECT_THROW(io::read_run_record(path), core::FileError);
}

TEST(ProcessMemory, GrowsWithWhatIsUsed)
{
    const std::uint64_t before = io::resident_bytes();
    const std::vector<char> block(64 << 20, 1);
    EXPECT_GE(io::resident_bytes(), before + (32u << 20));
    EXPECT_GE(io::peak_resident_bytes() + (1 << 20), io::resident_bytes());
}
