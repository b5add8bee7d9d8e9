/// Motion and force of one leaf's nodes as columns, one per component: what the lattice kernels read and write.
///
/// Lanes are cells, and cells that follow each other along z have nodes that do so: a corner of theirs is one piece of
/// a column, and nothing is transposed per cell. The grid keeps its nodes as lines (grid/levels.h); a leaf's are turned
/// into columns once per step and serve all of its blocks.
#pragma once

#include "grid/levels.h"
#include "transfer/cell_block.h"
#include "transfer/line_lanes.h"

#include <algorithm>

namespace transfer
{
/// One number per node of a tile, with room on both sides for vectors that hang over.
template <class T>
struct NodeColumn
{
    static constexpr int margin = part_lanes<T>;
    alignas(64) T number[margin + grid::tile_nodes + margin];
    T* at(int node) { return number + margin + node; }
    const T* at(int node) const { return number + margin + node; }
};

/// Relative to one node of the leaf's, so that single precision sees differences and not the distance the body has
/// travelled; slopes do not change by that.
template <class T>
struct MotionColumns
{
    NodeColumn<T> velocity[3];     // mm/ms
    NodeColumn<T> displacement[3]; // mm
};

template <class T>
using ForceColumns = NodeColumn<T>[3]; // N

namespace detail
{
/// Call visit(node) for pieces of N nodes that cover the rows of a box; the last may overlap the one before.
template <int N, class Visit>
[[gnu::always_inline]] inline void for_pieces(const grid::NodeBox& box, const Visit& visit)
{
    for (int i = box.lower[0]; i <= box.upper[0]; ++i) {
        const int end = grid::tile_index(i, box.upper[1] + 1, 0);
        for (int node = grid::tile_index(i, box.lower[1], 0); node < end; node += N)
            visit(std::min(node, grid::tile_nodes - N));
    }
}
} // namespace detail

/// @param box   rows that are wanted; what the columns hold elsewhere has no meaning
/// @param node0 a node that moves with the body, such as a corner of the leaf's first cell; motion is relative to it
template <class T>
[[gnu::noinline]] void read_motion(const grid::NodeMotion* tile, const grid::NodeBox& box, int node0,
                                   MotionColumns<T>& columns)
{
    constexpr int lanes = part_lanes<T>, size = line_piece<lanes>;
    using Piece = core::Pack<Real, size>;
    Piece first[8 / size];
    for (int n = 0; n < 8 / size; ++n) first[n] = Piece::load(tile[node0].velocity.data() + n * size);
    detail::for_pieces<lanes>(
        box, [&](int node) __attribute__((always_inline)) {
            PartLanes<T> line[8];
            lines_to_lanes(
                [&](int i, int place) __attribute__((always_inline)) {
                    return Piece::load(tile[node + i].velocity.data() + place) - first[place / size];
                },
                line);
            for (int a = 0; a < 3; ++a) {
                line[a].store(columns.velocity[a].at(node));
                line[4 + a].store(columns.displacement[a].at(node));
            }
        });
}

template <class T>
void clear(ForceColumns<T>& columns)
{
    for (NodeColumn<T>& column : columns) std::fill(std::begin(column.number), std::end(column.number), T(0));
}

/// Forces to the nodes of a tile, in the rows of a box and a few nodes beyond them.
template <class T>
[[gnu::noinline]] void write_forces(const ForceColumns<T>& columns, const grid::NodeBox& box, grid::NodeForce* tile)
{
    constexpr int size = std::min(core::native_lanes<Real>, 4);
    using Piece = core::Pack<Real, size>;
    const auto mass = !core::first_lanes<Real, size>(size - 1); // of the piece with fz: 1 / m stays
    detail::for_pieces<size>(
        box, [&](int node) __attribute__((always_inline)) {
            for (int place = 0; place < 4; place += size) {
                Piece square[size];
                for (int n = 0; n < size; ++n)
                    square[n] =
                        place + n < 3
                            ? core::convert<Real>(core::Pack<T, size>::load(columns[std::min(place + n, 2)].at(node)))
                            : Piece(Real(0));
                core::transpose(square);
                for (int n = 0; n < size; ++n) {
                    Real* target = tile[node + n].force.data() + place;
                    (place + size < 4 ? square[n] : core::select(mass, Piece::load(target), square[n])).store(target);
                }
            }
        });
}

namespace detail
{
/// Call visit(node, lanes) for every run of the part's cells along z: the node lane 0 has, or would have if the run
/// reached so far, and the run's lanes.
template <class T, class Visit>
[[gnu::always_inline]] inline void for_runs(const BlockPart<T>& part, const Visit& visit)
{
    const int count = part.count();
    for (unsigned starts = part.starts(); starts != 0;) {
        const int begin = std::countr_zero(starts);
        starts &= starts - 1;
        const int end = starts != 0 ? std::countr_zero(starts) : count;
        const auto upto = [](int lane) { return core::first_lanes<T, part_lanes<T>>(lane); };
        visit(part.node(begin) - begin, upto(end) & !upto(begin));
    }
}
} // namespace detail

/// Both vectors of motion at the corners of every cell, [component][corner]; zero in lanes without a cell.
template <class T>
[[gnu::always_inline]] inline void gather_corners(const MotionColumns<T>& columns, const BlockPart<T>& part,
                                                  PartLanes<T> (&velocity)[3][8], PartLanes<T> (&displacement)[3][8])
{
    using V = PartLanes<T>;
    const auto gather = [&](int node, const auto& keep) __attribute__((always_inline))
    {
        for (int a = 0; a < 3; ++a)
            for (int c = 0; c < 8; ++c) {
                const int corner = node + grid::tile_index(c >> 2, c >> 1 & 1, c & 1);
                velocity[a][c] = keep(V::load(columns.velocity[a].at(corner)), velocity[a][c]);
                displacement[a][c] = keep(V::load(columns.displacement[a].at(corner)), displacement[a][c]);
            }
    };
    if (part.one_run()) return gather(part.node(0), [](const V& fresh, const V&) { return fresh; });
    for (int a = 0; a < 3; ++a)
        for (int c = 0; c < 8; ++c) velocity[a][c] = displacement[a][c] = V(T(0));
    detail::for_runs(
        part, [&](int node, const core::Mask<T, part_lanes<T>>& lanes) __attribute__((always_inline)) {
            gather(node, [&](const V& fresh, const V& old) { return core::select(lanes, fresh, old); });
        });
}

/// Add forces at the corners of every cell, [component][corner], to the leaf's.
template <class T>
[[gnu::always_inline]] inline void scatter_corners(const PartLanes<T> (&force)[3][8], const BlockPart<T>& part,
                                                   ForceColumns<T>& columns)
{
    using V = PartLanes<T>;
    const auto scatter = [&](int node, const auto& only) __attribute__((always_inline))
    {
        // Corners k = 1 overlap those with k = 0 by all nodes but one: all others are served in between, so that what
        // is read has long been stored.
        for (int k = 0; k < 2; ++k)
            for (int pair = 0; pair < 4; ++pair)
                for (int a = 0; a < 3; ++a) {
                    T* target = columns[a].at(node + grid::tile_index(pair >> 1, pair & 1, k));
                    (V::load(target) + only(force[a][2 * pair + k])).store(target);
                }
    };
    if (part.one_run()) return scatter(part.node(0), [](const V& all) { return all; });
    detail::for_runs(
        part, [&](int node, const core::Mask<T, part_lanes<T>>& lanes) __attribute__((always_inline)) {
            scatter(node, [&](const V& all) { return core::select(lanes, all, V(T(0))); });
        });
}
} // namespace transfer
