#include "app/scene_features.h"

#include "io/diagnostics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace app
{
namespace
{
constexpr Real infinity = std::numeric_limits<Real>::infinity();

bool apart(const geometry::Bounds& a, const geometry::Bounds& b)
{
    return (a.lower.array() > b.upper.array()).any() || (b.lower.array() > a.upper.array()).any();
}

bool any_apart(const std::vector<solver::Body>& bodies)
{
    for (std::size_t i = 0; i < bodies.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (apart(bodies[i].shape.bounds(), bodies[j].shape.bounds())) return true;
    return false;
}

Real smallest_side(const solver::Problem& problem)
{
    Real smallest = infinity;
    for (const solver::Body& body : problem.bodies) {
        const geometry::Bounds bounds = body.shape.bounds();
        for (int a = 0; a < 3; ++a)
            if (const Real side = bounds.upper[a] - bounds.lower[a]; side > 1.5 * problem.grid.cell)
                smallest = std::min(smallest, side);
    }
    return smallest;
}

bool in_metal(const solver::Problem& problem, const Vec3& point)
{
    const Real slack = 1e-6 * problem.grid.cell; // faces that touch count
    for (unsigned planes = 0; planes < 1U << problem.symmetry.size(); ++planes) {
        Vec3 image = point; // beyond a symmetry plane lies what lies before it
        for (std::size_t i = 0; i < problem.symmetry.size(); ++i)
            if (const solver::SymmetryPlane& plane = problem.symmetry[i]; (planes >> i & 1U) != 0)
                image[plane.axis] = 2 * plane.at - image[plane.axis];
        for (const solver::Body& body : problem.bodies)
            if (body.shape.distance(image) <= slack) return true;
    }
    return false;
}

/// Whether metal faces a void on two opposite sides of its centre, as that of a hole or slot does; not that of a fillet
/// or a rounded corner.
bool between_metal(const solver::Problem& problem, const Vec3& centre, Real depth)
{
    const auto metal_along = [&](const Vec3& way) {
        for (const Real reach : {1.02, 1.1, 1.25})
            if (in_metal(problem, centre + reach * depth * way)) return true;
        return false;
    };
    for (int n = 14; n < 27; ++n) { // one of each pair of opposite directions of the lattice
        const Vec3 way = Vec3(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1).normalized();
        if (metal_along(way) && metal_along(-way)) return true;
    }
    return false;
}

/// Twice the depth of the centre in a void, which for a round hole is the diameter; edges and open ends have none. A
/// void that others overlap, such as a piece of a slot, is as wide as the widest of them is around its centre.
Real smallest_hole(const solver::Problem& problem)
{
    Real smallest = infinity;
    for (const solver::Feature& feature : problem.features) {
        if (feature.shape.distance(feature.centre) >= 0) continue;
        Real depth = 0;
        for (const solver::Feature& hole : problem.features)
            depth = std::max(depth, -hole.shape.distance(feature.centre));
        if (between_metal(problem, feature.centre, depth)) smallest = std::min(smallest, 2 * depth);
    }
    return smallest;
}

/// Furthest way a body flies or a load pushes until the end of the run.
Real travel(const solver::Problem& problem)
{
    Real speed = 0;
    for (const solver::Body& body : problem.bodies) speed = std::max(speed, body.velocity.norm());
    for (const solver::Load& load : problem.loads)
        for (const std::optional<Real>& component : load.velocity)
            speed = std::max(speed, std::abs(component.value_or(0)));
    if (speed == 0) return 0;
    return std::min(speed * problem.end.time, problem.end.cod);
}

/// Whether a strength of the law is ever reached.
bool breaks(const material::Decohesion& law)
{
    return std::isfinite(law.s_max) || std::isfinite(law.tau_max);
}
} // namespace

SceneFeatures scene_features(const solver::Problem& problem)
{
    SceneFeatures features;
    const Real hole = smallest_hole(problem), side = smallest_side(problem);
    features.contact = any_apart(problem.bodies);
    features.large_motion = features.contact || problem.numerics.formulation == solver::Formulation::updated ||
                            (std::isfinite(side) && travel(problem) > side);
    for (const material::Material& m : problem.materials) {
        features.plastic = features.plastic || m.plastic.has_value();
        features.crack = features.crack || (m.decohesion && breaks(*m.decohesion));
    }
    features.localised = !problem.zones.empty() || std::isfinite(hole);
    features.length = std::isfinite(hole) ? hole : std::isfinite(side) ? side : problem.grid.cell;
    return features;
}

std::string features_text(const SceneFeatures& features)
{
    std::vector<std::string> names;
    if (features.contact) names.emplace_back("contact");
    if (features.large_motion) names.emplace_back("large motion");
    if (features.plastic) names.emplace_back("plasticity");
    if (features.crack) names.emplace_back("crack");
    if (features.localised) names.emplace_back("localised feature");
    return names.empty() ? "small elastic motion" : io::joined(names);
}
} // namespace app
