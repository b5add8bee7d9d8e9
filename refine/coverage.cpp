#include "refine/coverage.h"

#include "refine/populate.h"

#include <algorithm>
#include <cmath>

namespace refine
{
namespace
{
/// `visit(cell)` for the cells of level 0 in the bounds until it returns true.
/// @return whether it did
template <class Visit>
bool any_cell(const Lattice& lattice, const geometry::Bounds& bounds, const Visit& visit)
{
    const Index3 lower = grid::cell_at((bounds.lower - lattice.origin) / lattice.spacing0, 0);
    const Index3 upper = grid::cell_at((bounds.upper - lattice.origin) / lattice.spacing0, 0);
    for (int i = lower[0]; i <= upper[0]; ++i)
        for (int j = lower[1]; j <= upper[1]; ++j)
            for (int k = lower[2]; k <= upper[2]; ++k)
                if (visit(Index3(i, j, k))) return true;
    return false;
}

Real half_diagonal(Real spacing)
{
    return spacing * std::sqrt(Real(3)) / 2;
}

bool reaches(const geometry::Shape& shape, const Vec3& lower, Real spacing)
{
    return shape.distance(lower + Vec3::Constant(spacing / 2)) <= half_diagonal(spacing);
}

bool seeds(const Scene& scene, const geometry::Shape& body, const grid::CellKey& key)
{
    const Real spacing = scene.lattice.spacing0 / static_cast<Real>(1 << key.level);
    const Vec3 lower = scene.lattice.origin + spacing * key.cell.cast<Real>();
    if (!reaches(body, lower, spacing)) return false;
    particles::Particles particles;
    return particles::seed_cell(body, {1, Vec3::Zero(), 0, scene.edge}, lower, spacing, scene.per_axis, key.level,
                                particles) > 0;
}

/// Is the node, a corner of cells of its own level, one that a load can hold?
bool can_be_held(const Scene& scene, const grid::Refinement& refinement, const grid::CellKey& node)
{
    const Real to_coarsest = Real(1) / static_cast<Real>(1 << node.level);
    const Vec3 at = to_coarsest * node.cell.cast<Real>();
    bool mass = false;
    for (int c = 0; c < 8; ++c) {
        const Vec3 towards(c & 4 ? 1 : -1, c & 2 ? 1 : -1, c & 1 ? 1 : -1);
        // A quarter of the finest cell away: in one cell, whatever its level.
        const grid::CellKey cell =
            refinement.locate(at + towards / (4 * static_cast<Real>(1 << (refinement.levels() - 1))));
        if (std::none_of(scene.bodies.begin(), scene.bodies.end(),
                         [&](const geometry::Shape& body) { return seeds(scene, body, cell); }))
            continue;
        const int side = cell.level < node.level ? 1 << (node.level - cell.level) : 1;
        for (int a = 0; a < 3; ++a)
            if (node.cell[a] % side != 0) return false; // hangs on a coarser cell
        mass = true;
    }
    return mass;
}
} // namespace

bool holds_particle(const Scene& scene, const geometry::Shape& body)
{
    if (any_cell(scene.lattice, body.bounds(), [&](const Index3& cell) { return seeds(scene, body, {0, cell}); }))
        return true;
    // Finer cells may see what coarse ones do not.
    particles::Particles particles;
    populate(body, {1, Vec3::Zero(), 0, scene.edge}, scene.lattice,
             refinement_of(scene.zones, scene.lattice, body.bounds()), scene.per_axis, particles);
    return particles.size() > 0;
}

bool holds_node(const Scene& scene, const geometry::Shape& region)
{
    const Lattice& lattice = scene.lattice;
    const geometry::Shape bodies = geometry::unite(scene.bodies);
    const geometry::Bounds near = geometry::intersect({region, geometry::grown(bodies, lattice.spacing0)}).bounds();
    // Balancing refines a coarse cell more for every level.
    const Vec3 rim = Vec3::Constant(lattice.spacing0 * (1 + lattice.levels));
    const grid::Refinement refinement = refinement_of(scene.zones, lattice, {near.lower - rim, near.upper + rim});
    for (int level = 0; level < lattice.levels; ++level) {
        const Real spacing = lattice.spacing0 / static_cast<Real>(1 << level);
        const Real tolerance = 1e-9 * spacing; // as solver::find_load_nodes
        const auto index = [&](const Vec3& x, Real shift) {
            return Index3((((x - lattice.origin) / spacing).array() + shift).floor().matrix().cast<int>());
        };
        const Index3 lower = index(near.lower, 1 - Real(1e-9)), upper = index(near.upper, Real(1e-9));
        for (int i = lower[0]; i <= upper[0]; ++i)
            for (int j = lower[1]; j <= upper[1]; ++j)
                for (int k = lower[2]; k <= upper[2]; ++k) {
                    const Vec3 at = lattice.origin + spacing * Vec3(i, j, k);
                    if (region.distance(at) > tolerance) continue;
                    if (bodies.distance(at) > 2 * half_diagonal(lattice.spacing0)) continue;
                    if (can_be_held(scene, refinement, {level, Index3(i, j, k)})) return true;
                }
    }
    return false;
}

bool refines(const Scene& scene, const Zone& zone)
{
    const Lattice& lattice = scene.lattice;
    const geometry::Shape bodies = geometry::unite(scene.bodies);
    const geometry::Shape region = geometry::grown(zone.shape, zone.margin + lattice.spacing0);
    return any_cell(lattice, geometry::intersect({region, bodies}).bounds(), [&](const Index3& cell) {
        const Vec3 lower = lattice.origin + lattice.spacing0 * cell.cast<Real>();
        return wanted_level({zone}, lower, lattice.spacing0) > 0 && reaches(bodies, lower, lattice.spacing0);
    });
}
} // namespace refine
