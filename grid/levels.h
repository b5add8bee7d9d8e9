/// The nested grid: per level the leaves (8^3 blocks) that particles reach, their node tiles, and how levels touch.
///
/// OpenVDB mask trees decide which leaves exist (grid/topology.cpp); the values live here in contiguous padded tiles,
/// one node = one cache line. A tile holds the 8^3 nodes its leaf owns plus one halo layer on the upper sides, so a
/// particle kernel never looks at a neighbour. A node of a halo is owned by the neighbour leaf.
///
/// Levels: 0 is coarsest, spacing(l) = spacing0 / 2^l, all lattices share `origin`. Leaves are numbered level by level,
/// inside a level in OpenVDB's tree order.
#pragma once

#include "core/real.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace grid
{
inline constexpr int leaf_side = 8;                                  // cells (and owned nodes) per axis
inline constexpr int leaf_cells = leaf_side * leaf_side * leaf_side; // 512
inline constexpr int tile_side = leaf_side + 1;                      // nodes per axis, trilinear support
inline constexpr int tile_nodes = tile_side * tile_side * tile_side; // 729

/// Position of a node in a tile; i, j, k in [0, 8]; z runs fastest as in OpenVDB leaves.
constexpr int tile_index(int i, int j, int k)
{
    return (i * tile_side + j) * tile_side + k;
}
/// Position of a cell in its leaf; i, j, k in [0, 7].
constexpr int cell_index(int i, int j, int k)
{
    return (i * leaf_side + j) * leaf_side + k;
}

/// What particles scatter to a node: one cache line.
struct alignas(64) NodeSum
{
    Real mass;                    // g
    std::array<Real, 3> momentum; // g mm/ms
    std::array<Real, 3> force;    // N
    Real spare;
};

/// What particles gather from a node: one cache line.
struct alignas(64) NodeMotion
{
    std::array<Real, 3> velocity; // mm/ms, after the momentum update
    Real spare0;
    std::array<Real, 3> change; // mm/ms, velocity after minus before (MUSL pass: velocity mapped again)
    Real spare1;
};

/// A node of the nodal scheme (grid/nodal.h), where momentum is never mapped: half a cache line.
struct alignas(32) NodeForce
{
    std::array<Real, 3> force; // N
    Real per_mass;             // 1/g, 0: never moves (no mass, or a slave)
    Real mass() const { return per_mass > 0 ? 1 / per_mass : Real(0); }
};

/// Mean velocity of a node of the nodal scheme, where damping has a memory (grid/damping.h).
struct alignas(32) NodeMean
{
    std::array<Real, 3> velocity; // mm/ms
    Real spare;
};

/// Tile indices [lower, upper] per axis; empty if upper < lower.
struct NodeBox
{
    std::array<std::int8_t, 3> lower{tile_side, tile_side, tile_side};
    std::array<std::int8_t, 3> upper{-1, -1, -1};
};

/// Every node of a tile.
inline constexpr NodeBox whole_tile{{0, 0, 0}, {leaf_side, leaf_side, leaf_side}};

struct Leaf
{
    int level = 0;
    Index3 origin = Index3::Zero();           // node index of the lower corner on its level, a multiple of 8
    std::array<std::int32_t, 27> neighbour{}; // leaf number at offset (a, b, c) in {-1,0,1}^3 at 9a+3b+c+13, or -1
};

/// A node named by leaf and place in that leaf's tile, always the owned copy.
struct NodeAddress
{
    std::int32_t leaf = -1;
    std::int32_t node = -1;
};

/// Master minus slave, in spacings of the fine level: -1, 0 or 1 along each axis.
using MasterOffset = std::array<std::int8_t, 3>;

/// What the corners of one cell collect of the particles' affine matrices (APIC): sum m w_i C [g/ms], the nine entries
/// of C row by row, for each the corners i = 4 x + 2 y + z.
struct alignas(64) CornerAffine
{
    std::array<std::array<Real, 8>, 9> entry;
};

/// Leaf cells of a fine level with a hanging corner: a slave between its masters, not at the place of one. There the
/// masters' positions matter, not only their weights (grid/hanging.h).
struct HangingCells
{
    std::vector<std::size_t> slot;                   // [c] leaf * 512 + cell, ascending
    std::vector<std::array<std::int32_t, 8>> slave;  // [c] slave at corner 4 x + 2 y + z, -1: does not hang
    std::vector<std::array<std::int32_t, 8>> around; // [s] cell that has the slave as corner 4 x + 2 y + z, or -1
    std::vector<CornerAffine> affine;                // [c] what particles scatter; empty unless APIC
    std::vector<std::array<Real, 9>> slave_affine;   // [s] g/ms, sum of `affine` over the cells around
};

/// Constrained interface nodes of one fine level and their masters one level coarser (methods.md A.3.2): rows of P
/// (slave -> masters, weights 1, 1/2, 1/4) and the same entries by master (P^T), both in compressed rows. No master is
/// a slave of the next coarser level: strong balance keeps a layer of cells in between.
struct LevelInterface
{
    std::vector<NodeAddress> slave;          // [s]
    std::vector<std::int32_t> row_start;     // [s + 1]
    std::vector<NodeAddress> row_master;     // [entries]
    std::vector<Real> row_weight;            // [entries] 1
    std::vector<MasterOffset> row_offset;    // [entries]
    std::vector<NodeAddress> master;         // [m]
    std::vector<std::int32_t> column_start;  // [m + 1]
    std::vector<std::int32_t> column_slave;  // [entries] index into slave
    std::vector<Real> column_weight;         // [entries] 1
    std::vector<MasterOffset> column_offset; // [entries]
    HangingCells hanging;
};

/// Which levels take part in a phase, and how long their steps are. Sub-cycling (methods.md A.7) doubles the step from
/// level to level; without it all levels step alike.
struct LevelSteps
{
    Real dt = 0;          // ms, of the finest level
    int first = 0;        // coarsest level that takes part; all finer ones do
    int finest = 0;       // finest level; matters if `doubled`
    bool doubled = false; // each level has twice the step of the next finer one
    Real of(int level) const { return doubled ? dt * static_cast<Real>(1 << (finest - level)) : dt; }
};

/// The mask trees; defined where OpenVDB may be included.
struct Topology;

struct Levels
{
    Real spacing0 = 0;          // mm
    int count = 1;              // number of levels
    Vec3 origin = Vec3::Zero(); // mm

    std::vector<Leaf> leaves;
    std::vector<std::int32_t> level_start; // [count + 1] leaves of level l are [level_start[l], level_start[l+1])
    std::vector<std::uint8_t> cell_active; // [leaf][512] 1: leaf cell of the hierarchy (in C_l)
    std::vector<std::uint32_t> cell_start; // [leaf * 512 + cell], + 1 entry: particle ranges by home cell
    std::vector<NodeSum> sum;              // [leaf][729]
    std::vector<NodeMotion> motion;        // [leaf][729]
    std::vector<NodeForce> force;          // [leaf][729] nodal scheme, instead of `sum`
    std::vector<NodeMean> mean;            // [leaf][729] nodal scheme, where damping has a memory
    std::vector<NodeBox> used;             // [leaf] holds all corners of active cells: no other node has mass
    std::vector<std::uint8_t> constrained; // [leaf][729] 1: owned node is a slave of the coarser level
    std::vector<LevelInterface> interface; // [count - 1] between level l and l + 1

    std::shared_ptr<const Topology> topology; // mask trees behind `leaves`

    /// Number of the first leaf of a level; level `count`: number of leaves.
    std::size_t first_leaf(int level) const
    {
        return static_cast<std::size_t>(level_start[static_cast<std::size_t>(level)]);
    }
    Real spacing(int level) const { return spacing0 / static_cast<Real>(1 << level); }
    NodeSum* sums(std::size_t leaf) { return sum.data() + leaf * tile_nodes; }
    const NodeSum* sums(std::size_t leaf) const { return sum.data() + leaf * tile_nodes; }
    NodeForce* forces(std::size_t leaf) { return force.data() + leaf * tile_nodes; }
    const NodeForce* forces(std::size_t leaf) const { return force.data() + leaf * tile_nodes; }
    NodeMean* means(std::size_t leaf) { return mean.data() + leaf * tile_nodes; }
    const NodeMean* means(std::size_t leaf) const { return mean.data() + leaf * tile_nodes; }
    NodeMotion* motions(std::size_t leaf) { return motion.data() + leaf * tile_nodes; }
    const NodeMotion* motions(std::size_t leaf) const { return motion.data() + leaf * tile_nodes; }
};
} // namespace grid
