#include "solver/surface.h"

#include "core/error.h"
#include "particles/tensors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace solver
{
namespace
{
/// A difference of shares below this is rounding.
constexpr Real least_jump = 1e-6;

/// Sub-cubes of one particle size, by lattice index.
using Cubes = std::unordered_map<std::uint64_t, Real>;

std::uint64_t key(const Index3& cube)
{
    constexpr int bias = 1 << 20;
    std::uint64_t k = 0;
    for (int a = 0; a < 3; ++a) k = k << 21 | static_cast<std::uint64_t>(cube[a] + bias);
    return k;
}

/// Share of metal in sub-cubes of all sizes.
struct Shares
{
    const Grid& grid;
    int per_axis;
    std::vector<Cubes> level;

    Real side(int l) const { return grid.cell / static_cast<Real>(1 << l) / per_axis; }
    Index3 cube(int l, const Vec3& x) const
    {
        const Vec3 at = (x - grid.origin) / side(l);
        return {static_cast<int>(std::floor(at[0])), static_cast<int>(std::floor(at[1])),
                static_cast<int>(std::floor(at[2]))};
    }
    Real at(int l, const Vec3& x) const
    {
        const auto& cubes = level[static_cast<std::size_t>(l)];
        const auto found = cubes.find(key(cube(l, x)));
        return found == cubes.end() ? Real(0) : std::min(Real(1), found->second);
    }
    /// Share beyond a face of a cube, whatever the size of the particles there.
    Real beyond(int l, const Vec3& centre, int axis, int sign) const
    {
        Vec3 next = centre;
        next[axis] += sign * side(l);
        if (const Real same = at(l, next); same > 0) return same;
        for (int coarser = l - 1; coarser >= 0; --coarser)
            if (const Real share = at(coarser, next); share > 0) return share;
        if (l + 1 >= grid.levels) return 0;
        Real sum = 0;
        for (int quarter = 0; quarter < 4; ++quarter) {
            Vec3 inner = centre;
            inner[axis] += sign * Real(0.75) * side(l);
            inner[(axis + 1) % 3] += (quarter & 1 ? 0.25 : -0.25) * side(l);
            inner[(axis + 2) % 3] += (quarter & 2 ? 0.25 : -0.25) * side(l);
            sum += at(l + 1, inner) / 4;
        }
        return sum;
    }
};

Shares shares_of(const Problem& problem, const Prepared& prepared, const particles::Particles& particles)
{
    Shares shares{problem.grid, prepared.per_axis, std::vector<Cubes>(static_cast<std::size_t>(problem.grid.levels))};
    const Real reach = 3 * problem.grid.cell / prepared.per_axis;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const Vec3 x = rest_of(particles, p);
        if (std::none_of(problem.surface_loads.begin(), problem.surface_loads.end(),
                         [&](const SurfaceLoad& load) { return load.region.distance(x) < reach; }))
            continue;
        const int l = particles.size_level[p];
        const Real side = shares.side(l);
        shares.level[static_cast<std::size_t>(l)][key(shares.cube(l, x))] +=
            particles.rest_volume[p] / (side * side * side);
    }
    return shares;
}

bool on_symmetry_plane(const Problem& problem, int axis, Real at, Real side)
{
    return std::any_of(problem.symmetry.begin(), problem.symmetry.end(), [&](const SymmetryPlane& plane) {
        return plane.axis == axis && std::abs(plane.at - at) < 1e-6 * side;
    });
}

/// Faces of one load with their vector areas in `force`.
void find_faces(const Problem& problem, const Shares& shares, const particles::Particles& particles, std::size_t index,
                std::vector<FaceForce>& faces)
{
    const SurfaceLoad& load = problem.surface_loads[index];
    for (std::uint32_t p = 0; p < particles.size(); ++p) {
        const Vec3 x = rest_of(particles, p);
        const int l = particles.size_level[p];
        const Real side = shares.side(l);
        if (load.region.distance(x) > side) continue;
        const Real own = std::min(Real(1), particles.rest_volume[p] / (side * side * side));
        for (int axis = 0; axis < 3; ++axis)
            for (const int sign : {-1, 1}) {
                Vec3 offset = Vec3::Zero();
                offset[axis] = sign * side / 2;
                if (load.region.distance(x + offset) > 1e-9 * side) continue;
                if (load.facing && sign * (*load.facing)[axis] <= 0) continue;
                if (on_symmetry_plane(problem, axis, x[axis] + offset[axis], side)) continue;
                const Real jump = own - shares.beyond(l, x, axis, sign);
                if (jump < least_jump) continue;
                Vec3 area = Vec3::Zero();
                area[axis] = sign * jump * side * side;
                faces.push_back({p, static_cast<std::int32_t>(index), offset, area});
            }
    }
}

/// Vector areas become forces.
void weigh_faces(const SurfaceLoad& load, std::size_t first, SurfaceForces& surface)
{
    Vec3 sum = Vec3::Zero();
    for (std::size_t f = first; f < surface.face.size(); ++f) sum += surface.face[f].force;
    const Vec3 normal = load.facing ? Vec3(load.facing->normalized()) : Vec3(sum / std::max(sum.norm(), Real(1e-300)));
    Real area = 0;
    for (std::size_t f = first; f < surface.face.size(); ++f)
        area += std::max(Real(0), surface.face[f].force.dot(normal));
    const bool closed = area <= 0;
    if (surface.face.size() == first || (closed && load.kind != SurfaceLoad::Kind::pressure))
        throw core::InputError(fmt::format("load '{}' finds no surface: no face of a body lies in its region{}",
                                           load.name, load.facing ? " and looks its way" : ""));
    Vec3 total = Vec3::Zero();
    for (std::size_t f = first; f < surface.face.size(); ++f) {
        Vec3& force = surface.face[f].force;
        if (load.kind == SurfaceLoad::Kind::pressure)
            force *= -load.pressure;
        else
            force = std::max(Real(0), force.dot(normal)) *
                    (load.kind == SurfaceLoad::Kind::force ? Vec3(load.vector / area) : load.vector);
        total += force;
    }
    surface.total.push_back(total);
    surface.area.push_back(area);
}
} // namespace

SurfaceForces find_surface_forces(const Problem& problem, const particles::Particles& particles,
                                  const Prepared& prepared)
{
    SurfaceForces surface;
    if (problem.surface_loads.empty()) return surface;
    const Shares shares = shares_of(problem, prepared, particles);
    for (std::size_t i = 0; i < problem.surface_loads.size(); ++i) {
        const std::size_t first = surface.face.size();
        find_faces(problem, shares, particles, i, surface.face);
        weigh_faces(problem.surface_loads[i], first, surface);
    }
    std::stable_sort(surface.face.begin(), surface.face.end(),
                     [](const FaceForce& a, const FaceForce& b) { return a.particle < b.particle; });
    surface.start.assign(particles.size() + 1, 0);
    for (const FaceForce& face : surface.face) ++surface.start[face.particle + 1];
    for (std::size_t p = 0; p < particles.size(); ++p) surface.start[p + 1] += surface.start[p];
    return surface;
}
} // namespace solver
