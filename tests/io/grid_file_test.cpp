#include "io/grid_file.h"

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/hdf5.h"
#include "io/particle_fields.h"
#include "io/vtkhdf_series.h"
#include "tests/io/file_faults.h"
#include "tests/io/sample_state.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace
{
using Boxes = std::vector<std::int32_t>;

std::filesystem::path write(const std::filesystem::path& folder, const solver::State& state)
{
    io::GridFileOptions options;
    options.fields.assign(io::grid_field_names.begin(), io::grid_field_names.end());
    options.version = "0.1.0";
    return io::write_grid_frame(folder, state.particles, state.levels, state.clock, options);
}

std::string level_path(int level, const std::string& what)
{
    return "/VTKHDF/Level" + std::to_string(level) + "/" + what;
}

/// Centres of the cells of a level in the order of the file, from its origin, spacing and boxes.
std::vector<Vec3> centres(const io::Hdf5Reader& file, int level)
{
    const std::vector<double> origin = file.attribute<double>("/VTKHDF", "Origin");
    const std::vector<double> h = file.attribute<double>(level_path(level, ""), "Spacing");
    const Boxes boxes = file.dataset<std::int32_t>(level_path(level, "AMRBox"));
    std::vector<Vec3> points;
    for (std::size_t b = 0; b < boxes.size(); b += 6)
        for (int k = boxes[b + 4]; k <= boxes[b + 5]; ++k)
            for (int j = boxes[b + 2]; j <= boxes[b + 3]; ++j)
                for (int i = boxes[b]; i <= boxes[b + 1]; ++i)
                    points.emplace_back(origin[0] + (i + 0.5) * h[0], origin[1] + (j + 0.5) * h[1],
                                        origin[2] + (k + 0.5) * h[2]);
    return points;
}

std::size_t refined_cells(const io::Hdf5Reader& file, int level)
{
    const auto ghost = file.dataset<std::uint8_t>(level_path(level, "CellData/vtkGhostType"));
    return static_cast<std::size_t>(std::count(ghost.begin(), ghost.end(), 8));
}

/// Place in the file of the cell of `level` that holds a point [mm].
std::size_t cell_at(const io::Hdf5Reader& file, int level, const Vec3& point)
{
    const double h = file.attribute<double>(level_path(level, ""), "Spacing").at(0);
    const std::vector<Vec3> places = centres(file, level);
    const auto holds = [&](const Vec3& centre) { return (centre - point).cwiseAbs().maxCoeff() < h / 2; };
    return static_cast<std::size_t>(std::find_if(places.begin(), places.end(), holds) - places.begin());
}
} // namespace

TEST(GridFile, DescribesTheLevelsAsVtkhdfWantsThem)
{
    const support::Folder folder;
    const solver::State state = sample::state();
    const auto path = write(folder.path(), state);
    EXPECT_EQ(path.filename(), "g_000400.hdf");
    const io::Hdf5Reader file(path);
    EXPECT_EQ(file.attribute<std::int64_t>("/VTKHDF", "Version"), (std::vector<std::int64_t>{1, 0}));
    EXPECT_EQ(file.text_attribute("/VTKHDF", "Type"), "OverlappingAMR");
    EXPECT_EQ(file.text_attribute("/VTKHDF", "GridDescription"), "XYZ");
    EXPECT_EQ(file.attribute<double>("/VTKHDF", "Origin"), (std::vector<double>{10, 20, 30}));
    EXPECT_EQ(file.attribute<double>("/VTKHDF/Level0", "Spacing"), (std::vector<double>{0.25, 0.25, 0.25}));
    EXPECT_EQ(file.attribute<double>("/VTKHDF/Level1", "Spacing"), (std::vector<double>{0.125, 0.125, 0.125}));
    EXPECT_FALSE(file.exists("/VTKHDF/Level2"));
    for (const char* group : {"PointData", "CellData", "FieldData"}) EXPECT_TRUE(file.exists(level_path(0, group)));
    EXPECT_EQ(file.attribute<double>("/", "time").at(0), state.clock.time);
    EXPECT_EQ(file.attribute<std::int64_t>("/", "step").at(0), 400);
    EXPECT_EQ(file.text_attribute("/", "units"), "mm-g-ms");
    EXPECT_EQ(file.text_attribute("/", "version"), "0.1.0");
    // Four layers of the coarse leaf, and the coarse cells that the fine leaf fills.
    EXPECT_EQ(file.dataset<std::int32_t>(level_path(0, "AMRBox")), (Boxes{0, 3, 0, 7, 0, 7, 4, 7, 0, 3, 0, 3}));
    EXPECT_EQ(file.dataset<std::int32_t>(level_path(1, "AMRBox")), (Boxes{8, 15, 0, 7, 0, 7}));
    EXPECT_EQ(refined_cells(file, 0), 4u * 4 * 4);
    EXPECT_EQ(refined_cells(file, 1), 0u);
}

// Seven layers of the finest cells: the last one fills half of the cells above it, and those are left out.
TEST(GridFile, ListsOnlyCoarseCellsThatFinerOnesFill)
{
    const support::Folder folder;
    const io::Hdf5Reader file(write(folder.path(), sample::three_levels()));
    EXPECT_EQ(file.dataset<std::int32_t>(level_path(0, "AMRBox")),
              (Boxes{0, 3, 0, 7, 0, 7, 4, 5, 0, 3, 0, 3, 6, 6, 0, 1, 0, 1}));
    EXPECT_EQ(file.dataset<std::int32_t>(level_path(1, "AMRBox")),
              (Boxes{8, 11, 0, 7, 0, 7, 12, 13, 0, 3, 0, 3, 14, 14, 0, 3, 0, 3}));
    EXPECT_EQ(file.dataset<std::int32_t>(level_path(2, "AMRBox")), (Boxes{24, 29, 0, 7, 0, 7, 30, 30, 0, 7, 0, 7}));
    EXPECT_EQ(refined_cells(file, 0), 2u * 4 * 4 + 2 * 2);
    EXPECT_EQ(refined_cells(file, 1), 3u * 4 * 4);
    EXPECT_EQ(refined_cells(file, 2), 0u);
}

// velocity = (x, 2 y, 3 z) in the samples, so its mean over a cell is that of the centre, on every level.
TEST(GridFile, HoldsMeansInTheirPlaces)
{
    const support::Folder folder;
    for (const solver::State& state : {sample::state(), sample::three_levels(), sample::three_levels(-16)}) {
        const io::Hdf5Reader file(write(folder.path(), state));
        for (int level = 0; level < state.levels.count; ++level) {
            const std::vector<Vec3> places = centres(file, level);
            const auto velocity = file.dataset<float>(level_path(level, "CellData/velocity"));
            const auto density = file.dataset<float>(level_path(level, "CellData/density"));
            const auto boxes = file.dataset<std::int32_t>(level_path(level, "AMRBox"));
            EXPECT_GE(*std::min_element(boxes.begin(), boxes.end()), 0);
            ASSERT_EQ(velocity.size(), 3 * places.size());
            ASSERT_EQ(density.size(), places.size());
            for (std::size_t c = 0; c < places.size(); ++c) {
                EXPECT_NEAR(density[c], 7.81e-3, 1e-8);
                for (std::size_t a = 0; a < 3; ++a)
                    ASSERT_NEAR(velocity[3 * c + a], (static_cast<Real>(a) + 1) * places[c][static_cast<int>(a)], 1e-4)
                        << "level " << level << ", cell " << c;
            }
        }
    }
}

TEST(GridFile, HoldsTheMassOfTheBodyInTheCellsThatAreSeen)
{
    const support::Folder folder;
    const solver::State state = sample::three_levels();
    const io::Hdf5Reader file(write(folder.path(), state));
    Real mass = 0;
    for (int level = 0; level < 3; ++level) {
        const auto density = file.dataset<float>(level_path(level, "CellData/density"));
        const auto ghost = file.dataset<std::uint8_t>(level_path(level, "CellData/vtkGhostType"));
        for (std::size_t c = 0; c < density.size(); ++c)
            if (ghost[c] == 0) mass += density[c] * std::pow(state.levels.spacing(level), 3);
    }
    const auto& column = state.particles.mass;
    EXPECT_NEAR(mass / std::accumulate(column.begin(), column.end(), Real(0)), 1, 1e-6);
}

TEST(GridFile, TakesMeansWeightedByMass)
{
    const support::Folder folder;
    solver::State state = sample::state();
    auto& particles = state.particles;
    particles.cracks[0].damage = 1;
    const std::size_t fine = 2048; // first particle of the fine leaf; its cell holds 8
    for (std::size_t p = fine; p < fine + 64; ++p) particles.crack[p] = p == fine ? 0 : -1;
    particles.mass[fine] *= 3;
    for (std::size_t c = 0; c < 6; ++c) particles.stress[c][fine] = 1000;
    const io::Hdf5Reader file(write(folder.path(), state));
    const std::size_t place = cell_at(file, 1, Vec3(11.06, 20.06, 30.06));
    EXPECT_FLOAT_EQ(file.dataset<float>(level_path(1, "CellData/damage")).at(place), 0.3f); // 3 / (3 + 7)
    EXPECT_FLOAT_EQ(file.dataset<float>(level_path(1, "CellData/density")).at(place), 7.81e-3f * 10 / 8);
    Real yz = 3 * 1000;
    for (std::size_t p = fine + 1; p < fine + 8; ++p) yz += particles.stress[4][p];
    EXPECT_FLOAT_EQ(file.dataset<float>(level_path(1, "CellData/stress")).at(6 * place + 4),
                    static_cast<float>(yz / 10));
}

TEST(GridFile, NamesUnitsAndConfiguration)
{
    const support::Folder folder;
    solver::State state = sample::state();
    {
        const io::Hdf5Reader file(write(folder.path(), state));
        EXPECT_EQ(file.text_attribute("/", "configuration"), "rest");
        EXPECT_EQ(file.text_attribute(level_path(1, "CellData/density"), "units"), "g/mm^3");
        for (const char* name : {"damage", "eq_plastic_strain", "von_mises", "stress", "velocity", "displacement"}) {
            const std::string path = level_path(0, "CellData/" + std::string(name));
            EXPECT_EQ(file.text_attribute(path, "units"), io::find_particle_field(name)->unit) << name;
            EXPECT_EQ(file.columns(path), io::find_particle_field(name)->components) << name;
        }
    }
    for (auto& column : state.particles.deformation_gradient) column.clear();
    state.particles.volume_ratio.assign(state.particles.size(), 1);
    EXPECT_EQ(io::Hdf5Reader(write(folder.path(), state)).text_attribute("/", "configuration"), "current");
}

TEST(GridSeries, ListsTheFramesAndRewinds)
{
    const support::Folder folder;
    const auto list = folder.path() / io::grid_files.list;
    io::rewind_series(list, 0.2); // a run without frames
    solver::State state = sample::state();
    for (const int step : {100, 200, 300}) {
        state.clock.step = step;
        state.clock.time = step * 1e-3;
        write(folder.path(), state);
    }
    const std::string full = io::read_file(list);
    EXPECT_PRED2(faults::contains, full, "g_000300.hdf");
    io::rewind_series(list, 0.2);
    EXPECT_FALSE(faults::contains(io::read_file(list), "g_000300.hdf"));
    write(folder.path(), state); // the resumed run comes to step 300 again
    EXPECT_EQ(io::read_file(list), full);
}

TEST(GridSeries, DoesNotListAFrameThatDidNotFitTheDisk)
{
    const support::Folder folder;
    solver::State state = sample::state();
    write(folder.path(), state);
    const std::string before = io::read_file(folder.path() / "grid.hdf.series");
    state.clock.step = 500;
    std::string message;
    {
        const faults::FileSizeLimit limit(5000);
        message = faults::message<core::FileError>([&] { write(folder.path(), state); });
    }
    EXPECT_PRED2(faults::contains, message, "g_000500.hdf': File too large");
    EXPECT_EQ(io::read_file(folder.path() / "grid.hdf.series"), before);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"g_000400.hdf", "grid.hdf.series"}));
}
