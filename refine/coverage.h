/// What a mesh will hold, asked of shapes before there is a mesh: so that a case is refused with its place in the file,
/// not by a run.
#pragma once

#include "particles/seed.h"
#include "refine/zone.h"

#include <vector>

namespace refine
{
struct Scene
{
    Lattice lattice;
    const std::vector<Zone>& zones;
    std::vector<geometry::Shape> bodies;
    particles::EdgeTreatment edge = particles::EdgeTreatment::fraction;
    int per_axis = 2; // particles per cell and axis
};

/// Does the body get a particle?
/// @cost  one cell for most bodies; all of them for one that is thinner than a cell everywhere
bool holds_particle(const Scene& scene, const geometry::Shape& body);

/// Does the region hold a node with mass: one that moves freely and is the corner of a cell with particles?
/// @cost  up to one query of the bodies per node of the region beside material; most regions end at the first node
bool holds_node(const Scene& scene, const geometry::Shape& region);

/// Does the zone refine a cell that a body reaches? None if it lies between centres and corners of the coarse cells.
bool refines(const Scene& scene, const Zone& zone);
} // namespace refine
