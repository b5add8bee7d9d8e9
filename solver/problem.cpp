#include "solver/problem.h"

namespace solver
{
Real Problem::symmetry_factor() const
{
    Real factor = 1;
    for (const SymmetryPlane& plane : symmetry)
        if (plane.axis != force_axis) factor *= 2;
    return factor;
}
} // namespace solver
