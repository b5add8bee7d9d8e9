#include "grid/interface.h"

#include "core/contract.h"
#include "core/parallel.h"
#include "grid/hanging.h"
#include "grid/topology.h"

#include <algorithm>

namespace grid
{
namespace
{
bool active(const Levels& levels, int level, const Index3& cell)
{
    return active_slot(levels, level, cell) >= 0;
}

/// A slave carries something only if a cell of its own level has it as a corner.
bool is_slave(const Levels& levels, int level, const Index3& node)
{
    bool own = false;
    bool coarse = false;
    for (int c = 0; c < 8; ++c) {
        const Index3 cell = node - Index3(c >> 2, c >> 1 & 1, c & 1);
        own = own || active(levels, level, cell);
        coarse = coarse || active(levels, level - 1, parent(cell));
    }
    return own && coarse;
}

NodeAddress address_of(const Levels& levels, int level, const Index3& node)
{
    const std::int32_t leaf = leaf_of(levels, level, node);
    CLEAVE_ASSERTS(leaf >= 0);
    const Index3 local = node - levels.leaves[static_cast<std::size_t>(leaf)].origin;
    return {leaf, tile_index(local[0], local[1], local[2])};
}

/// Masters of one slave: up to eight combinations of the parents along each axis.
void append_row(const Levels& levels, int coarse_level, const Index3& node, LevelInterface& face)
{
    for (int c = 0; c < 8; ++c) {
        Index3 master;
        MasterOffset offset{};
        Real weight = 1;
        bool counts = true;
        for (int a = 0; a < 3; ++a) {
            const int upper = c >> a & 1;
            const bool odd = (node[a] & 1) != 0;
            master[a] = (node[a] >> 1) + (odd ? upper : 0);
            if (odd) weight *= Real(0.5);
            offset[static_cast<std::size_t>(a)] = static_cast<std::int8_t>(2 * master[a] - node[a]);
            counts = counts && (odd || upper == 0);
        }
        if (!counts) continue;
        const NodeAddress at = address_of(levels, coarse_level, master);
        CLEAVE_ASSERTS(
            levels.constrained[static_cast<std::size_t>(at.leaf) * tile_nodes + static_cast<std::size_t>(at.node)] ==
            0);
        face.row_master.push_back(at);
        face.row_weight.push_back(weight);
        face.row_offset.push_back(offset);
    }
    face.row_start.push_back(static_cast<std::int32_t>(face.row_master.size()));
}

/// Turn the rows of P into the rows of P^T: entries by master, slaves in their own order.
void transpose(LevelInterface& face)
{
    const auto key = [](const NodeAddress& n) { return static_cast<std::int64_t>(n.leaf) * tile_nodes + n.node; };
    struct Entry
    {
        std::int64_t master;
        std::int32_t slave, entry;
    };
    std::vector<Entry> entries;
    for (std::size_t s = 0; s < face.slave.size(); ++s)
        for (std::int32_t e = face.row_start[s]; e < face.row_start[s + 1]; ++e)
            entries.push_back({key(face.row_master[static_cast<std::size_t>(e)]), static_cast<std::int32_t>(s), e});
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.master < b.master; });
    for (std::size_t e = 0; e < entries.size(); ++e) {
        if (e == 0 || entries[e].master != entries[e - 1].master) {
            face.column_start.push_back(static_cast<std::int32_t>(e));
            face.master.push_back(face.row_master[static_cast<std::size_t>(entries[e].entry)]);
        }
        face.column_slave.push_back(entries[e].slave);
        face.column_weight.push_back(face.row_weight[static_cast<std::size_t>(entries[e].entry)]);
        face.column_offset.push_back(face.row_offset[static_cast<std::size_t>(entries[e].entry)]);
    }
    face.column_start.push_back(static_cast<std::int32_t>(entries.size()));
}

NodeSum& at(Levels& levels, const NodeAddress& n)
{
    return levels.sums(static_cast<std::size_t>(n.leaf))[n.node];
}
NodeMotion& motion_at(Levels& levels, const NodeAddress& n)
{
    return levels.motions(static_cast<std::size_t>(n.leaf))[n.node];
}

/// Motion of a slave by its row of P.
NodeMotion prolonged(Levels& levels, const LevelInterface& face, std::size_t s)
{
    NodeMotion slave{};
    for (std::int32_t e = face.row_start[s]; e < face.row_start[s + 1]; ++e) {
        const Real w = face.row_weight[static_cast<std::size_t>(e)];
        const NodeMotion& master = motion_at(levels, face.row_master[static_cast<std::size_t>(e)]);
        for (std::size_t a = 0; a < 3; ++a) {
            slave.velocity[a] += w * master.velocity[a];
            slave.change[a] += w * master.change[a];
        }
    }
    return slave;
}

/// `add(master, weight, slave)` over all masters of one interface, then `clear(slave)` over all slaves.
template <class Add, class Clear>
void restrict_with(Levels& levels, const LevelInterface& face, const Add& add, const Clear& clear)
{
    core::parallel_for(face.master.size(), [&](std::size_t m) {
        NodeSum& master = at(levels, face.master[m]);
        for (std::int32_t e = face.column_start[m]; e < face.column_start[m + 1]; ++e) {
            const auto entry = static_cast<std::size_t>(e);
            add(master, face.column_weight[entry],
                at(levels, face.slave[static_cast<std::size_t>(face.column_slave[entry])]));
        }
    });
    for (const NodeAddress& slave : face.slave) clear(at(levels, slave));
}
} // namespace

void build_interfaces(Levels& levels)
{
    levels.constrained.assign(levels.leaves.size() * tile_nodes, 0);
    levels.interface.assign(static_cast<std::size_t>(levels.count - 1), LevelInterface{});
    for (int l = 1; l < levels.count; ++l) {
        LevelInterface& face = levels.interface[static_cast<std::size_t>(l - 1)];
        face.row_start.push_back(0);
        const auto first = static_cast<std::size_t>(levels.level_start[static_cast<std::size_t>(l)]);
        const auto last = static_cast<std::size_t>(levels.level_start[static_cast<std::size_t>(l) + 1]);
        for (std::size_t n = first; n < last; ++n)
            for (int i = 0; i < leaf_side; ++i)
                for (int j = 0; j < leaf_side; ++j)
                    for (int k = 0; k < leaf_side; ++k) {
                        const Index3 node = levels.leaves[n].origin + Index3(i, j, k);
                        if (!is_slave(levels, l, node)) continue;
                        const int place = tile_index(i, j, k);
                        levels.constrained[n * tile_nodes + static_cast<std::size_t>(place)] = 1;
                        face.slave.push_back({static_cast<std::int32_t>(n), place});
                        append_row(levels, l - 1, node, face);
                    }
        transpose(face);
        find_hanging_cells(levels, l, face);
    }
}

void restrict_sums(Levels& levels)
{
    for (std::size_t l = levels.interface.size(); l-- > 0;) {
        restrict_with(
            levels, levels.interface[l],
            [](NodeSum& master, Real w, const NodeSum& slave) {
                master.mass += w * slave.mass;
                for (std::size_t a = 0; a < 3; ++a) {
                    master.momentum[a] += w * slave.momentum[a];
                    master.force[a] += w * slave.force[a];
                }
            },
            [](NodeSum& slave) { slave = NodeSum{}; });
        restrict_affine(l, levels);
    }
}

void restrict_momentum(Levels& levels)
{
    for (std::size_t l = levels.interface.size(); l-- > 0;) {
        restrict_with(
            levels, levels.interface[l],
            [](NodeSum& master, Real w, const NodeSum& slave) {
                for (std::size_t a = 0; a < 3; ++a) master.momentum[a] += w * slave.momentum[a];
            },
            [](NodeSum& slave) { slave.momentum = {}; });
        restrict_affine(l, levels);
    }
}

void prolong_motion(Levels& levels)
{
    for (const LevelInterface& face : levels.interface)
        core::parallel_for(face.slave.size(),
                           [&](std::size_t s) { motion_at(levels, face.slave[s]) = prolonged(levels, face, s); });
}

void prolong_displacement(const LevelSteps& steps, Levels& levels)
{
    for (int l = std::max(1, steps.first); l < levels.count; ++l) {
        const LevelInterface& face = levels.interface[static_cast<std::size_t>(l) - 1];
        const Real per_dt = 1 / steps.of(l);
        core::parallel_for(face.slave.size(), [&](std::size_t s) {
            NodeMotion& slave = motion_at(levels, face.slave[s]);
            NodeMotion fresh = prolonged(levels, face, s);
            for (std::size_t a = 0; a < 3; ++a) fresh.velocity[a] = per_dt * (fresh.change[a] - slave.change[a]);
            slave = fresh;
        });
    }
}
} // namespace grid
