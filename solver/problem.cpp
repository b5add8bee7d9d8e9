#include "solver/problem.h"

namespace solver
{
Real Problem::symmetry_factor(int axis) const
{
    Real factor = 1;
    for (const SymmetryPlane& plane : symmetry)
        if (plane.axis != axis) factor *= 2;
    return factor;
}

geometry::Bounds Problem::bounds() const
{
    geometry::Bounds all = bodies.front().shape.bounds();
    for (const Body& body : bodies) {
        const geometry::Bounds own = body.shape.bounds();
        all.lower = all.lower.cwiseMin(own.lower);
        all.upper = all.upper.cwiseMax(own.upper);
    }
    return all;
}
} // namespace solver
