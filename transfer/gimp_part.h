/// What boxes of the basis `gimp` leave between the passes of a step (transfer/gimp_passes.h): no function, so that the
/// state can hold it.
#pragma once

#include "grid/levels.h"

#include <array>
#include <cstdint>
#include <vector>

namespace transfer
{
/// One axis of a part: weights, their slopes and the nodes' distances from the particle.
struct BoxAxis
{
    Real weight[2] = {}; // 1
    Real slope[2] = {};  // 1/mm
    Real arm[2] = {};    // mm, node minus particle
    Real sign = 1;       // -1: reflected at a symmetry plane
};

/// The part of a box that lies in one cell.
struct BoxPart
{
    std::int32_t leaf = -1;
    std::int32_t cell = -1; // of the leaf
    std::int32_t node = 0;  // lowest node in the leaf's tile
    bool reflected = false;
    std::array<std::int32_t, 3> corner{}; // lower corner of the cell, in cells of the finest level
    BoxAxis axis[3];
};

/// What a particle gives to every node it reaches, in lanes of grid::NodeSum.
struct alignas(64) BoxGift
{
    std::array<Real, 8> base;                 // mass, momentum
    std::array<std::array<Real, 8>, 3> slope; // [b] lanes 1 + a: m C(a, b) [g/ms]; lanes 4 + a: -V sigma(a, b) [N mm]
};

/// The particles of one leaf whose boxes had to be cut (gimp_box.h), in storage order.
struct CutBoxes
{
    std::vector<std::uint32_t> part_start; // [box + 1]
    std::vector<BoxPart> part;
    std::vector<BoxGift> gift; // [box]
    bool outside = false;      // some part lies in a cell that is not active: it is missing, cells must be built first
};

struct Boxes
{
    std::vector<CutBoxes> cut; // [leaf]

    /// All parts of cut boxes by the leaf they lie in: there they are added, so no sum has two writers.
    struct Arrival
    {
        std::uint32_t home, box, part; // leaf the particle is stored under, place in `cut` of it
    };
    std::vector<std::uint32_t> start; // [leaf + 1]
    std::vector<Arrival> arrival;

    std::vector<grid::NodeSum> skin;    // [leaf][skin_nodes] sums for nodes of neighbours (gimp_reach.h)
    std::vector<std::uint32_t> reached; // [leaf] bit d: there are some for the neighbour in direction d
};
} // namespace transfer
