#include "io/checkpoint.h"

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/state_columns.h"
#include "tests/io/file_faults.h"
#include "tests/io/sample_state.h"
#include "tests/solver/same_bits.h"
#include "tests/support/folder.h"
#include "tests/support/runs.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

namespace
{
using faults::contains;
using Names = std::vector<std::string>;

const io::CheckpointCase this_case{"[grid]\ncell = 0.25\nlevels = 2\n", "0.1.0"};

template <class T, class Allocator>
void expect_same_bits(const std::string& name, const std::vector<T, Allocator>& a, const std::vector<T, Allocator>& b)
{
    ASSERT_EQ(a.size(), b.size()) << name;
    EXPECT_EQ(a.empty() ? 0 : std::memcmp(a.data(), b.data(), a.size() * sizeof(T)), 0) << name;
}

/// All members of a vector of structs, as bits.
template <class Row>
std::vector<std::uint64_t> bits(std::vector<Row> rows)
{
    std::vector<std::uint64_t> values;
    for (Row& row : rows)
        io::visit_members(row, [&](const std::string&, auto& member) {
            std::uint64_t value = 0;
            std::memcpy(&value, &member, sizeof(member));
            values.push_back(value);
        });
    return values;
}

void expect_same(const solver::State& a, const solver::State& b)
{
    std::vector<particles::Column> reals;
    std::vector<std::vector<std::int64_t>> integers;
    particles::Particles::for_each_real(a.particles, [&](const std::string&, const auto& c) { reals.push_back(c); });
    particles::Particles::for_each_integer(
        a.particles, [&](const std::string&, const auto& c) { integers.emplace_back(c.begin(), c.end()); });
    std::size_t i = 0, j = 0;
    particles::Particles::for_each_real(
        b.particles, [&](const std::string& name, const auto& c) { expect_same_bits(name, reals[i++], c); });
    particles::Particles::for_each_integer(b.particles, [&](const std::string& name, const auto& c) {
        expect_same_bits(name, integers[j++], std::vector<std::int64_t>(c.begin(), c.end()));
    });
    EXPECT_EQ(bits(a.particles.cracks), bits(b.particles.cracks));
    EXPECT_EQ(bits(std::vector{a.clock}), bits(std::vector{b.clock}));
    EXPECT_EQ(bits(a.loads), bits(b.loads));
    EXPECT_EQ(bits(a.ligaments), bits(b.ligaments));
    EXPECT_EQ(bits(a.events), bits(b.events));
    EXPECT_EQ(bits(a.leaf_work), bits(b.leaf_work));
    EXPECT_EQ(bits(std::vector{a.folded_work}), bits(std::vector{b.folded_work}));
    EXPECT_EQ(a.initial_energy, b.initial_energy);
    EXPECT_EQ(a.source_work, b.source_work);
    EXPECT_EQ(a.damped_work, b.damped_work);
    ASSERT_EQ(a.samples.size(), b.samples.size());
    for (std::size_t s = 0; s < a.samples.size(); ++s) {
        EXPECT_EQ(a.samples[s].step, b.samples[s].step);
        EXPECT_EQ(a.samples[s].time, b.samples[s].time);
        EXPECT_EQ(a.samples[s].value, b.samples[s].value);
    }
    EXPECT_EQ(bits(a.history), bits(b.history));
    for (std::size_t l = 0; l < a.history.size(); ++l) EXPECT_EQ(a.history[l].particles, b.history[l].particles);
    EXPECT_EQ(a.gauge_upper, b.gauge_upper);
    EXPECT_EQ(a.gauge_lower, b.gauge_lower);
    EXPECT_EQ(a.gauge_start, b.gauge_start);
    EXPECT_EQ(a.largest_opening, b.largest_opening);

    EXPECT_EQ(a.levels.spacing0, b.levels.spacing0);
    EXPECT_EQ(a.levels.count, b.levels.count);
    EXPECT_EQ(a.levels.origin, b.levels.origin);
    EXPECT_EQ(a.levels.level_start, b.levels.level_start);
    EXPECT_EQ(a.levels.cell_active, b.levels.cell_active);
    EXPECT_EQ(a.levels.cell_start, b.levels.cell_start);
    ASSERT_EQ(a.levels.leaves.size(), b.levels.leaves.size());
    for (std::size_t l = 0; l < a.levels.leaves.size(); ++l) {
        EXPECT_EQ(a.levels.leaves[l].level, b.levels.leaves[l].level);
        EXPECT_EQ(a.levels.leaves[l].origin, b.levels.leaves[l].origin);
    }
}

solver::State at_step(std::int64_t step)
{
    solver::State state = sample::state();
    state.clock.step = step;
    return state;
}

void no_warning(const std::string& text)
{
    FAIL() << text;
}
} // namespace

TEST(Checkpoint, ReturnsEveryBit)
{
    const support::Folder folder;
    const solver::State state = sample::state();
    const auto path = io::write_checkpoint(folder.path(), state, this_case, 2);
    EXPECT_EQ(path.filename(), "ck_000400.h5");
    EXPECT_EQ(io::read_file(folder.path() / "latest"), "ck_000400.h5\n");
    expect_same(state, io::read_checkpoint(path, this_case));
}

TEST(Checkpoint, ReturnsAnIntactStateWithoutTheOptionalColumns)
{
    const support::Folder folder;
    solver::State state = sample::state();
    for (auto& column : state.particles.deformation_gradient) column.clear();
    state.particles.volume_ratio.assign(state.particles.size(), std::nextafter(1.0, 2.0));
    state.particles.cracks.clear();
    state.particles.crack.assign(state.particles.size(), -1);
    state.loads.clear();
    state.history.clear();
    state.gauge_lower.clear();
    expect_same(state, io::read_checkpoint(io::write_checkpoint(folder.path(), state, this_case, 2), this_case));
}

namespace
{
/// A bar that yields, is torn apart quickly and carries cracks after a while; nodal scheme.
support::Job torn_bar(const solver::Numerics& numerics)
{
    solver::Problem problem = support::bar(support::breakable(), 20, 0.01);
    problem.grid.levels = 2;
    problem.zones = {support::zone(geometry::box({-1, 1, -1}, {3, 2, 3}), 1)};
    problem.numerics = numerics;
    return support::started(problem);
}

/// Continue from the file as the program does.
support::Job from_file(support::Job& run, const std::filesystem::path& folder)
{
    std::filesystem::path path;
    {
        const solver::OutputColumns columns(run.state);
        path = io::write_checkpoint(folder, run.state, this_case, 1);
    }
    support::Job again{run.problem, run.prepared, {}, io::read_checkpoint(path, this_case)};
    solver::resume(again.problem, again.prepared, again.state, again.derived);
    return again;
}
} // namespace

// Cracks start before some checkpoints and after others.
TEST(Checkpoint, ANodalRunContinuesToTheSameBits)
{
    solver::Numerics damped = support::nodal_numerics(solver::Precision::mixed);
    damped.damping = 20;
    damped.damping_memory = 0.01;
    for (const solver::Numerics& numerics : {support::nodal_numerics(solver::Precision::f64), damped,
                                             support::subcycled_numerics(solver::Precision::mixed)})
    {
        const support::Folder folder;
        support::Job run = torn_bar(numerics);
        std::size_t found = 0, started = 0;
        for (int n = 0; n < 20; ++n) {
            support::advance(10, run);
            support::Job again = from_file(run, folder.path());
            const std::size_t cracks = run.state.particles.cracks.size();
            support::Job straight = run;
            support::advance(10, straight);
            support::advance(10, again);
            test::expect_same_particles(support::particles_of(straight), support::particles_of(again));
            test::expect_same_loads(straight.state.loads, again.state.loads);
            EXPECT_TRUE(test::same_bits(straight.state.levels.motion, again.state.levels.motion));
            EXPECT_TRUE(test::same_bits(straight.state.levels.force, again.state.levels.force));
            EXPECT_TRUE(test::same_bits(straight.state.levels.mean, again.state.levels.mean));
            EXPECT_EQ(straight.state.damped_work, again.state.damped_work);
            EXPECT_EQ(bits(straight.state.leaf_work), bits(again.state.leaf_work));
            ASSERT_FALSE(HasFailure()) << "from step " << run.state.clock.step;
            found += cracks > 0 ? 1 : 0;
            started += straight.state.particles.cracks.size() > cracks ? 1 : 0;
        }
        EXPECT_GT(found, 0U);
        EXPECT_LT(found, 20U);
        EXPECT_GT(started, 0U);
    }
}

TEST(Checkpoint, RefusesNodesThatDoNotFitTheLeaves)
{
    const support::Folder folder;
    support::Job run = torn_bar(support::nodal_numerics(solver::Precision::f64));
    const solver::OutputColumns columns(run.state);
    run.state.levels.motion.pop_back();
    const auto path = io::write_checkpoint(folder.path(), run.state, this_case, 1);
    EXPECT_PRED2(contains, faults::message<core::FileError>([&] { io::read_checkpoint(path, this_case); }),
                 "the nodes do not fit the leaves");
}

TEST(Checkpoint, KeepsTheNewestAndDropsLeftOversOfAnotherRun)
{
    const support::Folder folder;
    for (const int step : {900, 1000}) io::write_checkpoint(folder.path(), at_step(step), this_case, 2);
    for (const int step : {100, 200, 300}) io::write_checkpoint(folder.path(), at_step(step), this_case, 2);
    EXPECT_EQ(folder.names(), (Names{"ck_000200.h5", "ck_000300.h5", "latest"}));
    EXPECT_EQ(io::resume(folder.path(), this_case, no_warning)->clock.step, 300);
}

TEST(Checkpoint, FallsBackToTheOneBeforeADamagedOne)
{
    for (const bool cut : {true, false}) {
        const support::Folder folder;
        io::write_checkpoint(folder.path(), at_step(100), this_case, 2);
        const auto newest = io::write_checkpoint(folder.path(), at_step(200), this_case, 2);
        const auto size = std::filesystem::file_size(newest);
        if (cut)
            std::filesystem::resize_file(newest, size / 3);
        else {
            std::fstream file(newest, std::ios::in | std::ios::out | std::ios::binary);
            file.seekp(static_cast<std::streamoff>(size / 2));
            file.write("damage", 6);
        }
        EXPECT_THROW(io::read_checkpoint(newest, this_case), core::FileError);
        std::string warning;
        const auto state = io::resume(folder.path(), this_case, [&](const std::string& text) { warning = text; });
        ASSERT_TRUE(state.has_value());
        expect_same(at_step(100), *state);
        EXPECT_PRED2(contains, warning, "ck_000200.h5");
    }
}

TEST(Checkpoint, RefusesAnotherCaseAndSaysWhatDiffers)
{
    const support::Folder folder;
    const auto path = io::write_checkpoint(folder.path(), sample::state(), this_case, 2);
    const io::CheckpointCase other{"[grid]\ncell = 0.125\nlevels = 2\n", "0.1.0"};
    const std::string message =
        faults::message<core::InputError>([&] { io::resume(folder.path(), other, no_warning); });
    EXPECT_PRED2(contains, message, path.string());
    EXPECT_PRED2(contains, message, "another case");
    EXPECT_PRED2(contains, message, "'cell = 0.25' there and 'cell = 0.125' here");
}

// When to stop and when to keep a state change no step; what comes after them in the text counts again.
TEST(Checkpoint, AnotherEndOrIntervalIsTheSameCase)
{
    for (const std::string section : {"[end]\n", "[output.checkpoint]\n"}) {
        const auto of_case = [&](const std::string& free, const std::string& output) {
            return io::CheckpointCase{this_case.resolved + section + free + "\n[output.history]\n" + output, "0.1.0"};
        };
        const support::Folder folder;
        io::write_checkpoint(folder.path(), sample::state(), of_case("keep = 2\n", "every_cod = 0.1\n"), 2);
        EXPECT_TRUE(io::resume(folder.path(), of_case("at = 9\nkeep = 3\n", "every_cod = 0.1\n"), no_warning))
            << section;
        EXPECT_THROW(io::resume(folder.path(), of_case("keep = 2\n", "every_cod = 0.2\n"), no_warning),
                     core::InputError);
    }
}

TEST(Checkpoint, DistinguishesNoneFromNoneReadable)
{
    const support::Folder folder;
    EXPECT_FALSE(io::resume(folder.path() / "missing", this_case, no_warning).has_value());
    EXPECT_FALSE(io::resume(folder.path(), this_case, no_warning).has_value());
    io::write_file(folder.path() / "ck_000001.h5", "not HDF5");
    const std::string message =
        faults::message<core::FileError>([&] { io::resume(folder.path(), this_case, [](const std::string&) {}); });
    EXPECT_PRED2(contains, message, "no checkpoint can be read");
    EXPECT_PRED2(contains, message, "--force");
}

TEST(Checkpoint, LeavesTheEarlierOneWhenTheDiskIsFull)
{
    const support::Folder folder;
    io::write_checkpoint(folder.path(), at_step(100), this_case, 1);
    {
        const faults::FileSizeLimit limit(100000);
        EXPECT_THROW(io::write_checkpoint(folder.path(), at_step(200), this_case, 1), core::FileError);
    }
    EXPECT_EQ(folder.names(), (Names{"ck_000100.h5", "latest"}));
    EXPECT_EQ(io::resume(folder.path(), this_case, no_warning)->clock.step, 100);
}
