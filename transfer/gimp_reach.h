/// What the boxes of one leaf reach: its cells and one layer of cells around them, as one tile.
///
/// Nearly every box of a leaf lies in cells -1 .. 8 (along each axis), all of the leaf's level. A `ReachTile` holds the
/// nodes of those, -1 .. 9, so such a box is one tensor product of two or three nodes per axis, also when it reaches
/// into other leaves. It is filled from the motion tiles before the leaf gathers; sums scattered into it go to the
/// leaf's own tile, and the layers around it, the skin, to the neighbours in a second loop (docs/decisions/012).
///
/// Beyond a symmetry plane the nodes are the mirror images of those before it, so a box that reaches through the plane
/// is no special case either.
#pragma once

#include "transfer/passes.h"

namespace transfer
{
inline constexpr int reach_side = grid::tile_side + 2;                           // nodes -1 .. 9
inline constexpr int reach_nodes = reach_side * reach_side * reach_side;         // 1331
inline constexpr int skin_nodes = reach_nodes - grid::tile_nodes;                // 602
inline constexpr int reach_stride[3] = {reach_side * reach_side, reach_side, 1}; // of the three axes

/// Place of node (i, j, k) in a reach tile, and of the cell it is the lower corner of in a ReachMap; from -1 on.
constexpr int reach_index(int i, int j, int k)
{
    return ((i + 1) * reach_side + j + 1) * reach_side + k + 1;
}

template <class Node>
struct ReachTile
{
    Node node[reach_nodes];
};

/// Cells -1 .. 8 of the leaf that its particles' boxes may be in.
struct ReachBox
{
    std::array<int, 3> first{}, last{};
    bool empty() const { return last[0] < first[0]; }
};

/// A symmetry plane in reach.
struct Mirror
{
    int axis;
    int wall;  // node index in the leaf
    int image; // of the layer of images: wall - 1 or wall + 1; wall: none, there are cells on both sides
};

/// Where a box may lie to be served by the tile.
struct ReachMap
{
    ReachBox box;
    std::array<Mirror, 6> mirror;
    int mirrors = 0;
    /// [cell] bit c set: a box may begin in the cell and extend over one more cell along the axes of c (4 x + 2 y + z).
    std::uint8_t serves[reach_nodes];
};

/// The map of a leaf. Cells with hanging corners are left out for APIC: slaves between their masters take more than
/// sums over nodes (gimp_affine.h).
void map_reach(const PassOptions& options, const grid::Levels& levels, std::size_t leaf, ReachMap& map);

/// The motion of all nodes in reach.
void read_motion(const grid::Levels& levels, std::size_t leaf, const ReachMap& map, ReachTile<grid::NodeMotion>& tile);

void clear(const ReachMap& map, ReachTile<grid::NodeSum>& tile);

/// What is scattered: mass, momentum and force, or the momentum again (the rest of the tiles stays).
enum class BoxGive
{
    all,
    momentum,
};

/// Sums in reach to the leaf's tile and its skin. Folds images back, so `tile` is spent.
void write_sums(BoxGive give, std::size_t leaf, const ReachMap& map, ReachTile<grid::NodeSum>& tile,
                grid::Levels& levels, Boxes& boxes);

/// Add what the skins of all neighbours hold for this leaf.
void add_skins(const Boxes& boxes, std::size_t leaf, grid::Levels& levels);
} // namespace transfer
