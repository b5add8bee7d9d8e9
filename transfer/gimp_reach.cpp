#include "transfer/gimp_reach.h"

#include "core/simd.h"
#include "transfer/hanging_cell.h"

#include <algorithm>
#include <cstring>
#include <span>

namespace transfer
{
namespace
{
using Line = core::Pack<Real, 8>;

/// One step of -1, 0 or 1 along each axis, numbered as in grid::Leaf::neighbour.
struct Direction
{
    std::array<int, 3> step;
};
constexpr int own = 13;

constexpr Direction direction(int d)
{
    return {{d / 9 - 1, d / 3 % 3 - 1, d % 3 - 1}};
}

/// Nodes of the reach tile that the neighbour in a direction holds, first and one past the last along an axis; and what
/// to subtract to get that neighbour's index.
struct Layers
{
    int begin, end, shift;
};
constexpr Layers layers(int step)
{
    if (step < 0) return {-1, 0, -grid::leaf_side};
    if (step > 0) return {grid::tile_side, grid::tile_side + 1, grid::leaf_side};
    return {0, grid::tile_side, 0};
}

constexpr int nodes_towards(int d)
{
    const Direction to = direction(d);
    int count = 1;
    for (const int step : to.step) count *= step == 0 ? grid::tile_side : 1;
    return count;
}

/// First entry of every direction in a leaf's skin.
constexpr std::array<int, 28> skin_starts()
{
    std::array<int, 28> start{};
    for (int d = 0; d < 27; ++d)
        start[static_cast<std::size_t>(d) + 1] = start[static_cast<std::size_t>(d)] + (d == own ? 0 : nodes_towards(d));
    return start;
}
constexpr std::array<int, 28> skin_start = skin_starts();
static_assert(skin_start[27] == skin_nodes);

/// `visit(i, j, k, length)` for the rows of nodes towards a direction that the map's boxes touch, from node k on.
template <class Visit>
void for_rows(const ReachMap& map, int d, const Visit& visit)
{
    const Direction to = direction(d);
    int begin[3], end[3];
    for (std::size_t a = 0; a < 3; ++a) {
        const Layers all = layers(to.step[a]);
        begin[a] = std::max(all.begin, map.box.first[a]);
        end[a] = std::min(all.end, map.box.last[a] + 2);
    }
    if (begin[2] >= end[2]) return;
    for (int i = begin[0]; i < end[0]; ++i)
        for (int j = begin[1]; j < end[1]; ++j) visit(i, j, begin[2], end[2] - begin[2]);
}

/// Place of a node of the reach tile in the tile of the neighbour it belongs to.
int tile_place(int d, int i, int j, int k)
{
    const Direction to = direction(d);
    return grid::tile_index(i - layers(to.step[0]).shift, j - layers(to.step[1]).shift, k - layers(to.step[2]).shift);
}

/// Cells the leaf's particles sit in, and one more on every side.
ReachBox reach_of(const grid::Levels& levels, std::size_t leaf)
{
    const std::uint32_t* start = levels.cell_start.data() + leaf * grid::leaf_cells;
    ReachBox box{{grid::leaf_side, grid::leaf_side, grid::leaf_side}, {-1, -1, -1}};
    for (int i = 0; i < grid::leaf_side; ++i)
        for (int j = 0; j < grid::leaf_side; ++j) {
            const std::uint32_t* row = start + grid::cell_index(i, j, 0);
            if (row[0] == row[grid::leaf_side]) continue;
            int first = 0, last = grid::leaf_side - 1;
            while (row[first + 1] == row[0]) ++first;
            while (row[last] == row[grid::leaf_side]) --last;
            box.first = {std::min(box.first[0], i), std::min(box.first[1], j), std::min(box.first[2], first)};
            box.last = {std::max(box.last[0], i), std::max(box.last[1], j), std::max(box.last[2], last)};
        }
    if (box.empty()) return box;
    for (std::size_t a = 0; a < 3; ++a) {
        --box.first[a];
        ++box.last[a];
    }
    return box;
}

/// 1 for the active cells in reach.
void mark_active(const grid::Levels& levels, std::size_t leaf, ReachMap& map)
{
    std::memset(map.serves, 0, sizeof(map.serves));
    const grid::Leaf& home = levels.leaves[leaf];
    for (int i = map.box.first[0]; i <= map.box.last[0]; ++i)
        for (int j = map.box.first[1]; j <= map.box.last[1]; ++j) {
            const int column = 9 * ((i >> 3) + 1) + 3 * ((j >> 3) + 1);
            const auto cells = [&](int step) -> const std::uint8_t* {
                const std::int32_t n = home.neighbour[static_cast<std::size_t>(column + step + 1)];
                if (n < 0) return nullptr;
                return levels.cell_active.data() + static_cast<std::size_t>(n) * grid::leaf_cells +
                       grid::cell_index(i & 7, j & 7, 0);
            };
            std::uint8_t* row = map.serves + reach_index(i, j, 0);
            const int first = std::max(0, map.box.first[2]), last = std::min(grid::leaf_side - 1, map.box.last[2]);
            if (const std::uint8_t* here = cells(0))
                for (int k = first; k <= last; ++k) row[k] = here[k];
            if (map.box.first[2] < 0)
                if (const std::uint8_t* below = cells(-1)) row[-1] = below[grid::leaf_side - 1];
            if (map.box.last[2] == grid::leaf_side)
                if (const std::uint8_t* above = cells(1)) row[grid::leaf_side] = above[0];
        }
}

void leave_out_hanging(const grid::Levels& levels, std::size_t leaf, ReachMap& map)
{
    const grid::Leaf& home = levels.leaves[leaf];
    for (int d = 0; d < 27; ++d) {
        const std::int32_t n = home.neighbour[static_cast<std::size_t>(d)];
        if (n < 0) continue;
        const HangingRange range = hanging_cells(levels, static_cast<std::size_t>(n));
        for (std::size_t c = range.begin; c < range.end; ++c) {
            const int cell = static_cast<int>(range.face->hanging.slot[c] % grid::leaf_cells);
            int place[3] = {cell >> 6, cell >> 3 & 7, cell & 7};
            bool near = true;
            for (std::size_t a = 0; a < 3; ++a) {
                place[a] += grid::leaf_side * direction(d).step[a];
                near = near && place[a] >= -1 && place[a] <= grid::leaf_side;
            }
            if (near) map.serves[reach_index(place[0], place[1], place[2])] = 0;
        }
    }
}

/// `visit(place)` for the cells (corners 0) or nodes (corners 1) in layer `index` of an axis, as far as the map goes.
template <class Visit>
void for_layer(const ReachMap& map, int corners, int axis, int index, const Visit& visit)
{
    int begin[3], end[3];
    for (std::size_t a = 0; a < 3; ++a) {
        begin[a] = map.box.first[a];
        end[a] = map.box.last[a] + 1 + corners;
    }
    if (index < begin[axis] || index >= end[axis]) return;
    begin[axis] = index;
    end[axis] = index + 1;
    for (int i = begin[0]; i < end[0]; ++i)
        for (int j = begin[1]; j < end[1]; ++j)
            for (int k = begin[2]; k < end[2]; ++k) visit(reach_index(i, j, k));
}

/// Cells beyond walls that have cells on one side only become images. Boxes through the others are left to the cutter.
/// @return whether there was room for all walls
bool add_images(const PassOptions& options, const grid::Leaf& leaf, ReachMap& map)
{
    for (const grid::WallPlane& plane : options.walls) {
        const int wall = (plane.node0 << leaf.level) - leaf.origin[plane.axis];
        if (wall < 0 || wall > grid::leaf_side) continue;
        const int stride = reach_stride[plane.axis];
        unsigned below = 0, above = 0;
        for_layer(map, 0, plane.axis, wall - 1, [&](int place) { below |= map.serves[place]; });
        for_layer(map, 0, plane.axis, wall, [&](int place) { above |= map.serves[place]; });
        if (below == 0 && above == 0) continue;
        if (map.mirrors == static_cast<int>(map.mirror.size())) return false;
        const int image = below == above ? wall : below != 0 ? wall + 1 : wall - 1;
        map.mirror[static_cast<std::size_t>(map.mirrors++)] = {plane.axis, wall, image};
        if (image == wall) continue;
        for_layer(map, 0, plane.axis, image > wall ? wall : wall - 1,
                  [&](int place) { map.serves[place] = map.serves[place + (image > wall ? -stride : stride)]; });
    }
    return true;
}

/// From cells to boxes: bit c is set if the cells along all axes of c are.
void extend(ReachMap& map)
{
    std::uint8_t* t = map.serves;
    for (int bit = 1, a = 2; a >= 0; bit *= 2, --a) // z doubles the boxes of one cell, y those of two, x those of four
        for (int n = 0; n < reach_nodes - reach_stride[a]; ++n)
            t[n] = static_cast<std::uint8_t>(t[n] | (t[n] & t[n + reach_stride[a]]) << bit);
}

/// Sign of the lanes first + 0 .. 2 and 4 .. 6 turned for the component along the axis.
Line mirrored(Line line, int axis, int first)
{
    Line sign(Real(1));
    sign.v[first + axis] = -1;
    sign.v[4 + axis] = -1;
    return sign * line;
}

std::span<const Mirror> mirrors(const ReachMap& map)
{
    return {map.mirror.data(), static_cast<std::size_t>(map.mirrors)};
}

Line line_of(const grid::NodeSum& node)
{
    return Line::load(&node.mass);
}

bool holds_something(const grid::NodeSum& node)
{
    constexpr std::array<Real, 3> zero{};
    return node.mass != 0 || node.momentum != zero || node.force != zero;
}
} // namespace

void map_reach(const PassOptions& options, const grid::Levels& levels, std::size_t leaf, ReachMap& map)
{
    map.mirrors = 0;
    map.box = reach_of(levels, leaf);
    if (map.box.empty()) return;
    mark_active(levels, leaf, map);
    if (options.transfer == Transfer::apic) leave_out_hanging(levels, leaf, map);
    if (!add_images(options, levels.leaves[leaf], map)) {
        map.mirrors = 0;
        std::memset(map.serves, 0, sizeof(map.serves));
    }
    extend(map);
    constexpr unsigned along[3] = {0xf0, 0xcc, 0xaa}; // codes with a second cell along the axis
    for (const Mirror& m : mirrors(map)) {
        const auto keep = [&](int layer, unsigned codes) {
            for_layer(map, 0, m.axis, layer,
                      [&](int place) { map.serves[place] = static_cast<std::uint8_t>(map.serves[place] & codes); });
        };
        if (m.image == m.wall)
            keep(m.wall - 1, ~along[m.axis]);
        else if (m.image > m.wall)
            keep(m.wall, 0);
        else
            keep(m.wall - 1, along[m.axis]); // a box that begins among the images must go through the wall
    }
}

void read_motion(const grid::Levels& levels, std::size_t leaf, const ReachMap& map, ReachTile<grid::NodeMotion>& tile)
{
    for (int d = 0; d < 27; ++d) {
        const std::int32_t n = levels.leaves[leaf].neighbour[static_cast<std::size_t>(d)];
        if (n < 0) continue; // none of its nodes is reached
        const grid::NodeMotion* from = levels.motions(static_cast<std::size_t>(n));
        for_rows(map, d, [&](int i, int j, int k, int length) {
            std::copy_n(from + tile_place(d, i, j, k), length, tile.node + reach_index(i, j, k));
        });
    }
    for (const Mirror& m : mirrors(map)) {
        if (m.image == m.wall) continue;
        const int back = 2 * (m.wall - m.image) * reach_stride[m.axis];
        for_layer(map, 1, m.axis, m.image, [&](int place) {
            const Line line = Line::load(tile.node[place + back].velocity.data());
            mirrored(line, m.axis, 0).store(tile.node[place].velocity.data());
        });
    }
}

void clear(const ReachMap& map, ReachTile<grid::NodeSum>& tile)
{
    const int length = map.box.last[2] + 2 - map.box.first[2];
    for (int i = map.box.first[0]; i < map.box.last[0] + 2; ++i)
        for (int j = map.box.first[1]; j < map.box.last[1] + 2; ++j)
            std::fill_n(tile.node + reach_index(i, j, map.box.first[2]), length, grid::NodeSum{});
}

namespace
{
/// The nodes of the tile that may have mass; zero where the map does not go.
template <class Put>
void put_own(const ReachMap& map, const grid::NodeBox& used, const ReachTile<grid::NodeSum>& tile, grid::NodeSum* sums,
             const Put& put)
{
    const auto touched = [&](int index, std::size_t a) {
        return index >= map.box.first[a] && index < map.box.last[a] + 2;
    };
    const grid::NodeSum nothing{};
    const int first = used.lower[2], end = used.upper[2] + 1;
    const int from_here = std::max(first, map.box.first[2]), to_here = std::min(end, map.box.last[2] + 2);
    for (int i = used.lower[0]; i <= used.upper[0]; ++i)
        for (int j = used.lower[1]; j <= used.upper[1]; ++j) {
            grid::NodeSum* to = sums + grid::tile_index(i, j, 0);
            const grid::NodeSum* from = tile.node + reach_index(i, j, 0);
            const bool row = touched(i, 0) && touched(j, 1);
            const int begin = row ? from_here : end, stop = row ? to_here : end;
            for (int k = first; k < begin; ++k) put(to[k], nothing);
            for (int k = begin; k < stop; ++k) put(to[k], from[k]);
            for (int k = stop; k < end; ++k) put(to[k], nothing);
        }
}
} // namespace

void write_sums(BoxGive give, std::size_t leaf, const ReachMap& map, ReachTile<grid::NodeSum>& tile,
                grid::Levels& levels, Boxes& boxes)
{
    for (int n = map.mirrors; n-- > 0;) {
        const Mirror& m = map.mirror[static_cast<std::size_t>(n)];
        if (m.image == m.wall) continue;
        const int back = 2 * (m.wall - m.image) * reach_stride[m.axis];
        for_layer(map, 1, m.axis, m.image, [&](int place) {
            grid::NodeSum& real = tile.node[place + back];
            (line_of(real) + mirrored(line_of(tile.node[place]), m.axis, 1)).store(&real.mass);
            tile.node[place] = {};
        });
    }
    const grid::NodeBox& used = levels.used[leaf];
    if (give == BoxGive::all)
        put_own(map, used, tile, levels.sums(leaf), [](grid::NodeSum& to, const grid::NodeSum& from) { to = from; });
    else
        put_own(map, used, tile, levels.sums(leaf),
                [](grid::NodeSum& to, const grid::NodeSum& from) { to.momentum = from.momentum; });
    boxes.reached[leaf] = 0;
    if (map.box.empty()) return;
    std::uint32_t reached = 0;
    grid::NodeSum* skin = boxes.skin.data() + leaf * skin_nodes;
    for (int d = 0; d < 27; ++d) {
        if (d == own || levels.leaves[leaf].neighbour[static_cast<std::size_t>(d)] < 0) continue;
        const Direction towards = direction(d);
        const Layers x = layers(towards.step[0]), y = layers(towards.step[1]), z = layers(towards.step[2]);
        grid::NodeSum* to = skin + skin_start[static_cast<std::size_t>(d)];
        bool any = false;
        int touched = 0;
        for_rows(map, d, [&](int i, int j, int k, int length) {
            const grid::NodeSum* from = tile.node + reach_index(i, j, k);
            for (int n = 0; n < length && !any; ++n) any = holds_something(from[n]);
            touched += length;
        });
        if (!any) continue; // nobody reads the skin there
        reached |= 1U << d;
        if (touched < nodes_towards(d)) std::fill_n(to, nodes_towards(d), grid::NodeSum{});
        for_rows(map, d, [&](int i, int j, int k, int length) {
            std::copy_n(tile.node + reach_index(i, j, k), length,
                        to + ((i - x.begin) * (y.end - y.begin) + j - y.begin) * (z.end - z.begin) + k - z.begin);
        });
    }
    boxes.reached[leaf] = reached;
}

void add_skins(const Boxes& boxes, std::size_t leaf, grid::Levels& levels)
{
    grid::NodeSum* sums = levels.sums(leaf);
    for (int d = 0; d < 27; ++d) {
        const std::int32_t n = levels.leaves[leaf].neighbour[static_cast<std::size_t>(26 - d)]; // d leads here from it
        if (n < 0 || d == own || (boxes.reached[static_cast<std::size_t>(n)] >> d & 1) == 0) continue;
        const grid::NodeSum* from =
            boxes.skin.data() + static_cast<std::size_t>(n) * skin_nodes + skin_start[static_cast<std::size_t>(d)];
        const Layers x = layers(direction(d).step[0]), y = layers(direction(d).step[1]),
                     z = layers(direction(d).step[2]);
        for (int i = x.begin; i < x.end; ++i)
            for (int j = y.begin; j < y.end; ++j)
                for (int k = z.begin; k < z.end; ++k) {
                    grid::NodeSum& to = sums[tile_place(d, i, j, k)];
                    (line_of(to) + line_of(*from++)).store(&to.mass);
                }
    }
}
} // namespace transfer
