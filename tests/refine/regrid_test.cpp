// The leaf cells follow the particles whose zone asked for them; particles are split, never merged (methods.md A.3.6).
#include "refine/regrid.h"

#include "core/error.h"
#include "grid/topology.h"
#include "refine/populate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace
{
const Vec3 origin(0.3, -0.7, 1.1);
constexpr Real spacing0 = 0.5;
constexpr int per_axis = 2;

struct Body
{
    grid::Levels levels;
    particles::Particles particles;
};

/// 12 x 6 x 6 level-0 cells, three levels, the finest around (3, 3, 3).
Body seeded()
{
    Body body;
    body.levels.spacing0 = spacing0;
    body.levels.count = 3;
    body.levels.origin = origin;
    const refine::Lattice lattice{spacing0, origin, 3};
    const geometry::Shape shape = geometry::box(origin, origin + spacing0 * Vec3(12, 6, 6));
    const refine::Zone zone{
        "zone", geometry::box(origin + spacing0 * Vec3(2.6, 2.6, 2.6), origin + spacing0 * Vec3(3.4, 3.4, 3.4)), 2, 0};
    refine::populate(shape, {1, Vec3::Zero(), 0, {}}, lattice, refine::refinement_of({zone}, lattice, shape.bounds()),
                     per_axis, body.particles);
    body.particles.volume_ratio.assign(body.particles.size(), 1);
    return body;
}

grid::CellKey home(const Body& body, const grid::Refinement& refinement, std::size_t p)
{
    const auto& at = body.particles.position;
    return refinement.locate((Vec3(at[0][p], at[1][p], at[2][p]) - origin) * (1 / spacing0));
}

/// What solver::regrid does with cells and particles.
grid::Refinement regrid(Body& body)
{
    const grid::Refinement refinement = refine::refinement_from_targets(body.levels, body.particles);
    refine::split_into_finer_cells(body.levels, refinement, per_axis, body.particles);
    refine::order(transfer::Formulation::updated, refinement, body.levels, body.particles);
    return refinement;
}

void shift(Body& body, Real cells)
{
    for (Real& x : body.particles.position[0]) x += cells * spacing0;
}

void expect_balanced(const grid::Refinement& refinement)
{
    const Real finest = 0.25;
    for (Real x = -2 * finest; x < 16; x += finest)
        for (Real y = -2 * finest; y < 7; y += finest)
            for (Real z = -2 * finest; z < 7; z += finest) {
                const Vec3 at = Vec3(x, y, z) + Vec3::Constant(finest / 2);
                const int level = refinement.locate(at).level;
                for (int n = 0; n < 27; ++n) {
                    const Vec3 beyond = at + finest * Vec3(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
                    ASSERT_LE(std::abs(refinement.locate(beyond).level - level), 1) << at.transpose();
                }
            }
}

void expect_particles_fit(const Body& body, const grid::Refinement& refinement)
{
    for (std::size_t p = 0; p < body.particles.size(); ++p) {
        const int level = home(body, refinement, p).level;
        ASSERT_GE(level, body.particles.target_level[p]);
        ASSERT_GE(body.particles.size_level[p], level);
    }
}

Real total(const particles::Column& column)
{
    return std::accumulate(column.begin(), column.end(), Real(0));
}
} // namespace

TEST(Regrid, cells_at_rest_are_those_of_the_zone_and_nothing_is_split)
{
    Body body = seeded();
    const std::size_t count = body.particles.size();
    const grid::Refinement refinement = regrid(body);
    EXPECT_EQ(body.particles.size(), count);
    for (std::size_t p = 0; p < count; ++p) ASSERT_EQ(home(body, refinement, p).level, body.particles.size_level[p]);
    expect_balanced(refinement);
}

TEST(Regrid, fine_cells_follow_their_particles_and_stay_balanced)
{
    for (const Real cells : {0.3, 1.0, 2.7, -1.6}) {
        Body body = seeded();
        shift(body, cells);
        const grid::Refinement refinement = regrid(body);
        expect_particles_fit(body, refinement);
        expect_balanced(refinement);
        const auto level_at = [&](Real x) { return refinement.locate(Vec3(x + cells, 3.1, 3.1)).level; };
        EXPECT_EQ(level_at(3.0), 2);
        EXPECT_EQ(level_at(7.5), 0); // nothing asked for finer cells here
    }
}

TEST(Regrid, one_particle_alone_brings_a_balanced_neighbourhood)
{
    Body body = seeded();
    for (std::size_t p = 0; p < body.particles.size(); ++p) {
        body.particles.target_level[p] = 0;
        body.particles.size_level[p] = 2; // nothing to split
    }
    body.particles.target_level[11] = 2;
    for (std::size_t a = 0; a < 3; ++a) // in the corner of a level-0 cell
        body.particles.position[a][11] = origin[static_cast<int>(a)] + 3.05 * spacing0;
    const grid::Refinement refinement = regrid(body);
    expect_balanced(refinement);
    EXPECT_EQ(refinement.locate({3.1, 3.1, 3.1}).level, 2);
    EXPECT_EQ(refinement.locate({2.9, 2.9, 2.9}).level, 1);
    EXPECT_EQ(refinement.locate({1.9, 3.1, 3.1}).level, 0);
}

// Coarse particles in cells that have become fine are split; mass and volume stay, also when the zone comes back.
TEST(Regrid, coarse_particles_in_fine_cells_are_split_and_never_merged)
{
    Body body = seeded();
    const Real mass = total(body.particles.mass), volume = total(body.particles.rest_volume);
    const std::size_t seeded_count = body.particles.size();
    // The wanted level stays with the metal; only these particles move, through metal that stays.
    std::vector<std::uint32_t> zone_ids;
    for (std::size_t p = 0; p < seeded_count; ++p)
        if (body.particles.target_level[p] == 2) zone_ids.push_back(body.particles.id[p]);
    ASSERT_FALSE(zone_ids.empty());
    const auto move_zone = [&](Real cells) {
        for (std::size_t p = 0; p < body.particles.size(); ++p)
            if (body.particles.target_level[p] == 2) body.particles.position[0][p] += cells * spacing0;
    };
    move_zone(5);
    expect_particles_fit(body, regrid(body));
    const std::size_t moved_count = body.particles.size();
    EXPECT_GT(moved_count, seeded_count);
    EXPECT_NEAR(total(body.particles.mass) / mass, 1, 1e-13);
    EXPECT_NEAR(total(body.particles.rest_volume) / volume, 1, 1e-13);

    move_zone(-5);
    expect_particles_fit(body, regrid(body));
    EXPECT_EQ(body.particles.size(), moved_count); // back where it was: all is fine enough, nothing is merged
    move_zone(5);
    regrid(body);
    EXPECT_EQ(body.particles.size(), moved_count);
}

// Children keep the target of their parent: split particles do not ask for more fine cells.
TEST(Regrid, the_fine_region_does_not_grow_by_itself)
{
    Body body = seeded();
    shift(body, 0.3);
    regrid(body);
    const std::size_t count = body.particles.size();
    const std::vector<std::uint8_t> active = body.levels.cell_active;
    for (int n = 0; n < 3; ++n) {
        regrid(body);
        EXPECT_EQ(body.particles.size(), count);
        EXPECT_EQ(body.levels.cell_active, active);
    }
}

TEST(Regrid, a_cracked_particle_stays_whole)
{
    Body body = seeded();
    std::size_t coarse = 0;
    while (body.particles.size_level[coarse] != 0) ++coarse;
    const std::uint32_t id = body.particles.id[coarse];
    body.particles.crack[coarse] = 0;
    body.particles.cracks.emplace_back();
    for (std::size_t a = 0; a < 3; ++a) // into the finest cells
        body.particles.position[a][coarse] = origin[static_cast<int>(a)] + 3.1 * spacing0;
    regrid(body);
    for (std::size_t p = 0; p < body.particles.size(); ++p)
        if (body.particles.id[p] == id) {
            EXPECT_EQ(body.particles.size_level[p], 0);
        }
}

TEST(Regrid, particles_are_ordered_by_leaf_cell_and_number)
{
    Body body = seeded();
    shift(body, 0.7);
    std::fill(body.particles.away.begin(), body.particles.away.end(), std::uint8_t(1));
    const grid::Refinement refinement = regrid(body);
    const auto& start = body.levels.cell_start;
    ASSERT_EQ(start.size(), body.levels.leaves.size() * grid::leaf_cells + 1);
    ASSERT_EQ(start.back(), body.particles.size());
    for (std::size_t slot = 0; slot + 1 < start.size(); ++slot) {
        EXPECT_EQ(body.levels.cell_active[slot] != 0, start[slot] != start[slot + 1]);
        for (std::uint32_t p = start[slot]; p < start[slot + 1]; ++p) {
            const grid::CellKey key = home(body, refinement, p);
            ASSERT_EQ(grid::active_slot(body.levels, key.level, key.cell), static_cast<std::int64_t>(slot));
            ASSERT_TRUE(p == start[slot] || body.particles.id[p - 1] < body.particles.id[p]);
            ASSERT_EQ(body.particles.away[p], 0);
        }
    }
}

// No number, or beyond what an index of a cell can name.
TEST(Regrid, a_position_that_is_no_place_names_the_particle)
{
    for (const Real away : {std::numeric_limits<Real>::quiet_NaN(), 1e12}) {
        Body body = seeded();
        body.particles.position[1][7] = away;
        const grid::Refinement refinement(3);
        try {
            refine::order(transfer::Formulation::updated, refinement, body.levels, body.particles);
            FAIL() << "no error";
        } catch (const core::NumericalError& error) {
            EXPECT_NE(std::string(error.what()).find("particle " + std::to_string(body.particles.id[7]) + " "),
                      std::string::npos);
        }
    }
}
