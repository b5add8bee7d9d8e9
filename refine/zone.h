/// Refinement zones: where the case asks for finer cells.
#pragma once

#include "geometry/shape.h"
#include "grid/refinement.h"

#include <string>
#include <vector>

namespace refine
{
struct Zone
{
    std::string name;
    geometry::Shape shape;
    int level = 0;
    Real margin = 0; // mm
};

/// Where the cells lie.
struct Lattice
{
    Real spacing0 = 0;          // mm
    Vec3 origin = Vec3::Zero(); // mm
    int levels = 1;
};

/// Highest level of a zone that holds the point, grown by its margin; 0 if none does.
int level_at(const std::vector<Zone>& zones, const Vec3& point);

/// Level a cell should have: the highest level of a zone that holds its centre or one of its corners, grown by its
/// margin; 0 if none does.
int wanted_level(const std::vector<Zone>& zones, const Vec3& lower, Real spacing);

/// Subdivide every cell inside `bounds` that a zone wants finer, then balance.
/// @cost  one distance query per zone and cell corner
grid::Refinement refinement_of(const std::vector<Zone>& zones, const Lattice& lattice, const geometry::Bounds& bounds);
} // namespace refine
