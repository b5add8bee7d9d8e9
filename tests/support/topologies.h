/// The ways levels can meet: blocks of cells on which every property of the hierarchy is checked.
#pragma once

#include "grid/levels.h"
#include "grid/refinement.h"

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace support
{
struct Topology
{
    std::string name;
    grid::Refinement refinement;
    std::vector<grid::CellKey> cells; // leaf cells of the block
};

/// Block [-half, half)^3 of level-0 cells with the wanted cells subdivided, balanced.
/// @param wanted  asked for every cell of every level but the finest: subdivide it?
Topology topology_of(const std::string& name, int levels, int half,
                     const std::function<bool(const grid::CellKey&)>& wanted);

/// One level, a flat face, a box zone with edges and corners, a re-entrant zone, three nested levels, all refined.
const std::vector<Topology>& topologies();

/// Levels built for a topology; origin off zero, so that a forgotten origin shows.
grid::Levels levels_of(const Topology& topology, Real spacing0 = 0.5);

/// Position [mm] of a node of a tile.
Vec3 position_of(const grid::Levels& levels, const grid::NodeAddress& at);

/// `visit(address, position)` for every owned, unconstrained corner of a leaf cell: the degrees of freedom.
void for_each_free_node(const grid::Levels& levels,
                        const std::function<void(const grid::NodeAddress&, const Vec3&)>& visit);

std::ostream& operator<<(std::ostream& out, const Topology& topology);
} // namespace support
