/// transfer/separate_lanes.h: which particles of a cell start to separate, and on whose stress.
#include "transfer/separate_lanes.h"

#include "tests/support/scene.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace
{
/// One of the eight particles of a cell.
struct Place
{
    Real tension = 0; // MPa, along x
    std::uint8_t material = 0;
    bool here = true; // served by this visit
};
using Cell = std::array<Place, 8>;

/// Places of the particles that start; the first material breaks at 10 MPa, the second never.
std::vector<std::uint32_t> started(const Cell& cell, bool smoothed_onset)
{
    material::Material metal = support::soft_elastic();
    metal.decohesion.emplace();
    metal.decohesion->s_max = 10;
    metal.decohesion->tau_max = std::numeric_limits<Real>::infinity();
    metal.decohesion->energy_1 = 1;
    metal.decohesion->smoothed_onset = smoothed_onset;
    support::Topology topology = support::topology_of("cell", 1, 1, [](const grid::CellKey&) { return false; });
    std::erase_if(topology.cells, [](const grid::CellKey& key) { return key.cell != Index3::Zero(); });
    transfer::PassOptions options;
    options.dt = 1e-4;
    support::Scene scene =
        support::scene_of(topology, options, {metal, support::soft_elastic()}, support::Layout::regular);
    core::Sym<Real> stress[8]{};
    core::Mat<Real> gradient[8]{};
    bool here[8];
    for (std::size_t p = 0; p < cell.size(); ++p) {
        stress[p].s[0] = cell[p].tension;
        scene.particles.material[p] = cell[p].material;
        here[p] = cell[p].here;
    }
    std::vector<transfer::Onset> onset;
    transfer::start_cracks(scene.options, scene.laws, scene.particles, 0, cell.size(), 0.5, stress, gradient, here,
                           onset);
    std::vector<std::uint32_t> places;
    for (const transfer::Onset& one : onset) places.push_back(one.particle);
    return places;
}

using Places = std::vector<std::uint32_t>;
} // namespace

TEST(StartCracks, smoothed_onset_takes_the_mean_of_the_own_material)
{
    const auto mixed = [](Real breaking, Real other) {
        Cell cell;
        for (std::size_t p = 0; p < cell.size(); ++p)
            cell[p] = p % 2 == 0 ? Place{breaking + (p < 4 ? -3 : 3), 0} : Place{other, 1};
        return started(cell, true);
    };
    EXPECT_EQ(mixed(11, 0), (Places{0, 2, 4, 6}));
    EXPECT_EQ(mixed(9, 0), Places());
    EXPECT_EQ(mixed(9, 1000), Places());
}

// Another visit serves what has left the cell, with the gradient of the place it has come to.
TEST(StartCracks, particles_that_have_left_the_cell_are_not_tested_and_do_not_count)
{
    for (const bool smoothed_onset : {true, false}) {
        Cell cell;
        cell.fill({9});
        cell[3] = {1000, 0, false};
        EXPECT_EQ(started(cell, smoothed_onset), Places());
        cell.fill({11});
        cell[3] = {-1000, 0, false};
        cell[5] = {1000, 0, false};
        EXPECT_EQ(started(cell, smoothed_onset), (Places{0, 1, 2, 4, 6, 7}));
    }
}
