#include "io/vdb_file.h"

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/voxel_sums.h"
#include "tests/io/file_faults.h"
#include "tests/io/sample_state.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <numeric>

namespace
{
using openvdb::FloatGrid;

io::VdbFileOptions options()
{
    io::VdbFileOptions options;
    options.grids.assign(io::vdb_grid_names.begin(), io::vdb_grid_names.end());
    options.version = "0.1.0";
    return options;
}

std::filesystem::path write(const std::filesystem::path& folder, const solver::State& state,
                            const io::VdbFileOptions& options, int frame = 1)
{
    return io::write_vdb_frame(folder, frame, state.particles, state.levels, state.clock, options);
}

template <class Grid>
typename Grid::Ptr read_grid(const std::filesystem::path& path, const std::string& name)
{
    openvdb::initialize();
    openvdb::io::File file(path.string());
    file.open();
    return openvdb::gridPtrCast<Grid>(file.readGrid(name));
}

Real total_mass(const solver::State& state)
{
    return std::accumulate(state.particles.mass.begin(), state.particles.mass.end(), Real(0));
}

Real summed_mass(const solver::State& state)
{
    Real sum = 0;
    for (const io::VoxelBlock& block : io::sum_voxels(state.particles, state.levels, 8))
        for (const float mass : block.mass) sum += mass;
    return sum;
}

/// Value at a point [mm] of the case, by the transform of the grid.
template <class Grid>
auto value_at(const Grid& grid, const Vec3& point)
{
    const auto index = grid.transform().worldToIndexCellCentered({point.x(), point.y(), point.z()});
    return grid.tree().getValue(index);
}
} // namespace

// Alone in its cell, 128 voxels wide, and it has moved: it touches 129 along every axis.
TEST(VdbFile, a_particle_of_the_coarsest_of_eight_levels_is_spread_whole)
{
    grid::Levels levels;
    levels.count = 8;
    levels.spacing0 = 1;
    particles::Particles particles;
    particles.mass = particles.rest_volume = {1};
    particles.eq_plastic_strain = {0};
    particles.crack = {-1};
    particles.size_level = {0};
    for (std::size_t a = 0; a < 3; ++a) {
        particles.position[a] = {0.503};
        particles.velocity[a] = {0};
    }
    Real sum = 0;
    int touched = 0;
    for (const io::VoxelBlock& block : io::sum_voxels(particles, levels, 1))
        for (const float mass : block.mass) {
            sum += mass;
            touched += mass > 0;
        }
    EXPECT_EQ(touched, 129 * 129 * 129);
    EXPECT_NEAR(sum, 1, 1e-5);
}

TEST(VoxelSums, KeepTheMassWhereverTheParticlesAre)
{
    solver::State state = sample::state();
    EXPECT_NEAR(summed_mass(state) / total_mass(state), 1, 1e-6);
    for (auto& x : state.particles.position)
        for (Real& value : x) value = value * 1.07 - 2.3;
    EXPECT_NEAR(summed_mass(state) / total_mass(state), 1, 1e-5); // shares below 1e-6 are dropped
}

TEST(VdbFile, FillsCoarseAndFineRegionsWithTheDensityOfTheBody)
{
    const support::Folder folder;
    const solver::State state = sample::state();
    const auto density = read_grid<FloatGrid>(write(folder.path(), state, options()), "density");
    // 4 x 8 x 8 coarse cells of 0.25 mm are 8 x 16 x 16 voxels; 8 x 8 x 8 fine cells of 0.125 mm are as many voxels.
    EXPECT_EQ(density->activeVoxelCount(), 8u * 16 * 16 + 8 * 8 * 8);
    for (auto voxel = density->cbeginValueOn(); voxel; ++voxel) EXPECT_NEAR(*voxel, 7.81e-3, 7.81e-6);
    EXPECT_EQ(density->getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_TRUE(density->saveFloatAsHalf());
}

TEST(VdbFile, CentresVoxelsOnCells)
{
    const support::Folder folder;
    const solver::State state = sample::state(); // velocity = (x, 2 y, 3 z)
    const auto velocity = read_grid<openvdb::Vec3SGrid>(write(folder.path(), state, options()), "velocity");
    const Vec3 coarse(10.0625 + 3 * 0.125, 20.0625 + 5 * 0.125, 30.0625), fine(11.0625, 20.0625, 30.0625 + 0.25);
    for (const Vec3& point : {coarse, fine}) {
        const openvdb::Vec3s v = value_at(*velocity, point);
        EXPECT_NEAR(v[0], point[0], 0.01); // half floats have 11 bits
        EXPECT_NEAR(v[1], 2 * point[1], 0.04);
        EXPECT_NEAR(v[2], 3 * point[2], 0.07);
    }
    EXPECT_EQ(velocity->getVectorType(), openvdb::VEC_CONTRAVARIANT_RELATIVE);
    EXPECT_EQ(value_at(*velocity, Vec3(9.99, 20.1, 30.1)), openvdb::Vec3s(0)); // outside the body
}

TEST(VdbFile, TakesMeansWeightedByMass)
{
    const support::Folder folder;
    solver::State state = sample::state();
    auto& particles = state.particles;
    particles.cracks[0].damage = 1;
    const std::size_t fine = 2048; // first particle of the fine leaf; its voxel holds 8
    for (std::size_t p = fine; p < fine + 8; ++p) particles.crack[p] = p == fine ? 0 : -1;
    particles.mass[fine] *= 3;
    const auto damage = read_grid<FloatGrid>(write(folder.path(), state, options()), "damage");
    EXPECT_NEAR(value_at(*damage, Vec3(11.01, 20.01, 30.01)), 0.3, 1e-3); // 3 / (3 + 7)
}

TEST(VdbFile, NamesScalesAndDescribesForThePreset)
{
    const support::Folder folder;
    const solver::State state = sample::state();
    io::VdbFileOptions houdini = options();
    houdini.preset = "houdini";
    houdini.scale = 0.1;
    const auto path = write(folder.path(), state, houdini, 7);
    EXPECT_EQ(path.filename(), "vol_0007.vdb");
    EXPECT_NEAR(read_grid<openvdb::Vec3SGrid>(path, "vel")->voxelSize()[0], 0.0125, 1e-12);
    EXPECT_NEAR(value_at(*read_grid<FloatGrid>(path, "density"), Vec3(1.01, 2.01, 3.01)), 7.81e-3, 7.81e-6);

    openvdb::io::File file(path.string());
    file.open();
    EXPECT_EQ(file.getMetadata()->metaValue<double>("time"), state.clock.time);
    EXPECT_EQ(file.getMetadata()->metaValue<std::int64_t>("step"), 400);
    EXPECT_EQ(file.getMetadata()->metaValue<std::string>("units"), "mm-g-ms");
    EXPECT_EQ(file.getMetadata()->metaValue<double>("scene_units_per_mm"), 0.1);
    EXPECT_EQ(file.readGrid("vel")->getCreator(), "cleave 0.1.0");
    EXPECT_EQ(file.readGrid("vel")->metaValue<std::string>("units"), "mm/ms");
}

TEST(VdbFile, CountsTheFramesUpToAStep)
{
    const support::Folder folder;
    solver::State state = sample::state();
    EXPECT_EQ(io::last_vdb_frame(folder.path(), 1000).number, 0);
    EXPECT_EQ(io::last_vdb_frame(folder.path(), 1000).step, -1);
    for (int frame = 1; frame <= 3; ++frame) {
        state.clock.step = 100 * frame;
        write(folder.path(), state, options(), frame);
    }
    EXPECT_EQ(io::last_vdb_frame(folder.path(), 99).number, 0);
    EXPECT_EQ(io::last_vdb_frame(folder.path(), 200).number, 2);
    EXPECT_EQ(io::last_vdb_frame(folder.path(), 250).step, 200);
    EXPECT_EQ(io::last_vdb_frame(folder.path(), 1000).number, 3);
    io::write_file(folder.path() / "vol_0002.vdb", "no volume");
    EXPECT_THROW(io::last_vdb_frame(folder.path(), 1000), core::FileError);
}

TEST(VdbFile, LeavesNothingWhenTheDiskIsFull)
{
    const support::Folder folder;
    std::string message;
    {
        const faults::FileSizeLimit limit(3000);
        message = faults::message<core::FileError>([&] { write(folder.path(), sample::state(), options()); });
    }
    EXPECT_PRED2(faults::contains, message, "vol_0001.vdb': File too large");
    EXPECT_TRUE(folder.names().empty());
}
