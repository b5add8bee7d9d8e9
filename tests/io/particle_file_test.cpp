#include "io/particle_file.h"

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/hdf5.h"
#include "io/particle_columns.h"
#include "io/vtkhdf_series.h"
#include "tests/io/file_faults.h"
#include "tests/io/sample_state.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

namespace
{
using Names = std::vector<std::string>;

Names all_fields()
{
    Names names;
    for (const io::ParticleField& field : io::particle_fields) names.emplace_back(field.name);
    return names;
}

std::filesystem::path write(const std::filesystem::path& folder, const solver::State& state,
                            io::Precision precision = io::Precision::f32)
{
    return io::write_particle_frame(folder, state.particles, state.levels, state.clock,
                                    {.fields = all_fields(), .precision = precision, .version = "0.1.0"});
}

std::vector<Real> column(const char* name, const solver::State& state)
{
    return io::particle_column(*io::find_particle_field(name), state.particles, state.levels);
}
} // namespace

TEST(ParticleFile, HoldsEveryFieldOfTheTableWithItsUnit)
{
    const support::Folder folder;
    const solver::State state = sample::state();
    const auto path = write(folder.path(), state);
    EXPECT_EQ(path.filename(), "p_000400.hdf");
    const io::Hdf5Reader file(path);
    for (const io::ParticleField& field : io::particle_fields) {
        const std::string data = "/VTKHDF/PointData/" + std::string(field.name);
        EXPECT_EQ(file.columns(data), field.components) << data;
        EXPECT_EQ(file.text_attribute(data, "units"), field.unit);
        const std::vector<Real> expected = io::particle_column(field, state.particles, state.levels);
        const std::vector<float> stored = file.dataset<float>(data);
        EXPECT_EQ(stored, std::vector<float>(expected.begin(), expected.end())) << data;
        EXPECT_EQ(stored.size(), state.particles.size() * static_cast<std::size_t>(field.components));
    }
    EXPECT_EQ(file.attribute<double>("/", "time").at(0), state.clock.time);
    EXPECT_EQ(file.attribute<std::int64_t>("/", "step").at(0), 400);
    EXPECT_EQ(file.text_attribute("/", "units"), "mm-g-ms");
    EXPECT_EQ(file.text_attribute("/", "version"), "0.1.0");
}

TEST(ParticleFile, KeepsAllDigitsWhenAsked)
{
    const support::Folder folder;
    const solver::State state = sample::state();
    const io::Hdf5Reader file(write(folder.path(), state, io::Precision::f64));
    EXPECT_EQ(file.dataset<double>("/VTKHDF/Points"), io::particle_points(state.particles));
    EXPECT_EQ(file.dataset<double>("/VTKHDF/PointData/von_mises"), column("von_mises", state));
}

TEST(ParticleColumns, MeanWhatTheTableSays)
{
    solver::State state = sample::state();
    particles::Particles& particles = state.particles;
    for (std::size_t c = 0; c < 6; ++c) particles.stress[c][3] = 0;
    particles.stress[0][3] = -250; // uniaxial: the equivalent stress is its size
    for (std::size_t c = 0; c < 6; ++c) particles.stress[c][4] = c < 3 ? 70 : 0;
    particles.stress[4][4] = 10; // pressure and shear: sqrt(3) times the shear
    EXPECT_DOUBLE_EQ(column("von_mises", state)[3], 250);
    EXPECT_DOUBLE_EQ(column("von_mises", state)[4], 10 * std::sqrt(3.0));

    const std::size_t cracked = 10, intact = 11;
    EXPECT_EQ(column("damage", state)[cracked], particles.cracks[1].damage);
    EXPECT_EQ(column("damage", state)[intact], 0);
    EXPECT_EQ(column("failure_mode", state)[cracked], 2);
    EXPECT_EQ(column("crack_normal", state)[3 * cracked + 2], 0.8);
    EXPECT_NEAR(column("displacement", state)[3 * intact + 1], 0.02, 1e-12);
    EXPECT_EQ(column("level", state).front(), 0);
    EXPECT_EQ(column("level", state).back(), 1);

    const Real J = 1.1 * (1.1 * 1.1 - 1e-4) - 0.01 * (0.011 - 1e-4) + 0.01 * (1e-4 - 0.011);
    EXPECT_NEAR(column("volume", state)[5], J * particles.rest_volume[5], 1e-15);
    for (auto& c : particles.deformation_gradient) c.clear();
    particles.volume_ratio.assign(particles.size(), 0.9);
    EXPECT_DOUBLE_EQ(column("volume", state)[5], 0.9 * particles.rest_volume[5]);
}

TEST(ParticleSeries, ListsTheFramesInOrderOfTimeAndRewinds)
{
    const support::Folder folder;
    solver::State state = sample::state();
    for (const int step : {100, 200, 300}) {
        state.clock.step = step;
        state.clock.time = step * 1e-3;
        write(folder.path(), state);
    }
    const auto series = folder.path() / "particles.hdf.series";
    const std::string full = io::read_file(series);
    EXPECT_PRED2(faults::contains, full, "\"file-series-version\": \"1.0\"");
    io::rewind_series(series, 0.2);
    EXPECT_PRED2(faults::contains, io::read_file(series), "p_000200.hdf");
    EXPECT_FALSE(faults::contains(io::read_file(series), "p_000300.hdf"));
    write(folder.path(), state); // the resumed run comes to step 300 again
    EXPECT_EQ(io::read_file(series), full);
    EXPECT_EQ(io::read_last_particle_frame(folder.path(), {})->step, 300);
    EXPECT_EQ(folder.names(), (Names{"p_000100.hdf", "p_000200.hdf", "p_000300.hdf", "particles.hdf.series"}));
}

TEST(ParticleSeries, DoesNotListAFrameThatDidNotFitTheDisk)
{
    const support::Folder folder;
    solver::State state = sample::state();
    write(folder.path(), state);
    const std::string before = io::read_file(folder.path() / "particles.hdf.series");
    state.clock.step = 500;
    {
        const faults::FileSizeLimit limit(20000);
        EXPECT_THROW(write(folder.path(), state), core::FileError);
    }
    EXPECT_EQ(io::read_file(folder.path() / "particles.hdf.series"), before);
    EXPECT_EQ(folder.names(), (Names{"p_000400.hdf", "particles.hdf.series"}));
}

TEST(ParticleFrame, GivesTheReportPlaceSideAndFields)
{
    const support::Folder folder;
    EXPECT_FALSE(io::read_last_particle_frame(folder.path(), {"damage"}).has_value());
    const solver::State state = sample::state();
    write(folder.path(), state);
    const auto frame = io::read_last_particle_frame(folder.path(), {"damage", "not_there"});
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->time, state.clock.time);
    EXPECT_EQ(frame->scalar.size(), 1u);
    EXPECT_FLOAT_EQ(frame->side.front(), 0.125f);
    EXPECT_FLOAT_EQ(frame->side.back(), 0.0625f);
    EXPECT_FLOAT_EQ(frame->position[2][9], static_cast<float>(state.particles.position[2][9]));
}
