/// transfer/strays.h: particles that leave the block they fill.
#include "transfer/strays.h"

#include "core/error.h"
#include "grid/topology.h"
#include "tests/support/scene.h"

#include <gtest/gtest.h>

namespace
{
/// Two levels that meet at x = 0, fine below, four coarse cells wide.
support::Scene two_levels(transfer::Basis basis)
{
    transfer::PassOptions options;
    options.formulation = transfer::Formulation::updated;
    options.basis = basis;
    const support::Topology block =
        support::topology_of("flat face", 2, 2, [](const grid::CellKey& key) { return key.cell[0] < 0; });
    return support::scene_of(block, options, {support::soft_elastic()}, support::Layout::regular);
}

/// A particle of the level put at a level-0 lattice coordinate; where it is a stray then, or -1.
std::int64_t slot_of_stray(const Vec3& scaled, int level, support::Scene& scene)
{
    particles::Particles& particles = scene.particles;
    std::size_t p = 0;
    while (particles.target_level[p] != level || particles.away[p] != 0) ++p;
    const Vec3 x = scene.levels.origin + scene.levels.spacing0 * scaled;
    for (std::size_t a = 0; a < 3; ++a) particles.position[a][p] = x[static_cast<int>(a)];
    particles.away[p] = 1;
    transfer::assign_all(scene.options, particles, scene.levels, scene.strays);
    for (std::size_t s = 0; s < scene.strays.size(); ++s)
        if (scene.strays.particle[s] == p)
            return std::int64_t{scene.strays.leaf[s]} * grid::leaf_cells + scene.strays.cell[s];
    return -1;
}
} // namespace

TEST(Strays, enter_empty_cells_of_their_own_level_without_an_ordering)
{
    support::Scene scene = two_levels(transfer::Basis::trilinear);
    const std::size_t leaves = scene.levels.leaves.size();
    EXPECT_LT(grid::active_slot(scene.levels, 0, {2, 0, 0}), 0);
    const std::int64_t coarse = slot_of_stray({2.5, 0.5, 0.5}, 0, scene);
    const std::int64_t fine = slot_of_stray({-2.25, 0.25, 0.25}, 1, scene);
    EXPECT_GE(coarse, 0);
    EXPECT_GE(fine, 0);
    EXPECT_EQ(coarse, grid::active_slot(scene.levels, 0, {2, 0, 0}));
    EXPECT_EQ(fine, grid::active_slot(scene.levels, 1, {-5, 0, 0}));
    EXPECT_FALSE(scene.strays.outside);
    EXPECT_EQ(scene.levels.leaves.size(), leaves);
    EXPECT_EQ(scene.strays.refinement.locate({-2.25, 0.25, 0.25}).level, 1);
}

TEST(Strays, ask_for_an_ordering_where_levels_meet_or_no_leaf_is)
{
    for (const Vec3& scaled : {Vec3(0.5, 2.5, 0.5), Vec3(20, 0.5, 0.5)}) {
        support::Scene scene = two_levels(transfer::Basis::trilinear);
        EXPECT_LT(slot_of_stray(scaled, 0, scene), 0);
        EXPECT_TRUE(scene.strays.outside) << scaled.transpose();
        EXPECT_TRUE(transfer::worth_reordering(scene.options, scene.strays, scene.particles));
    }
}

TEST(Strays, with_boxes_ask_for_an_ordering_beyond_what_the_boxes_reached)
{
    support::Scene scene = two_levels(transfer::Basis::gimp);
    EXPECT_LT(slot_of_stray({4.5, 0.5, 0.5}, 0, scene), 0);
    EXPECT_TRUE(scene.strays.outside);
}

// No index can name its cell, so no ordering helps: the computation is unstable.
TEST(Strays, flung_beyond_all_cells_end_the_run)
{
    for (const transfer::Basis basis : {transfer::Basis::trilinear, transfer::Basis::gimp})
        for (const Vec3& scaled : {Vec3(1e12, 0.5, 0.5), Vec3(0.5, 0.5, -1e12)}) {
            support::Scene scene = two_levels(basis);
            EXPECT_THROW(slot_of_stray(scaled, 0, scene), core::NumericalError) << scaled.transpose();
        }
}
