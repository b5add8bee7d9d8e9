#include "grid/refinement.h"

#include "core/contract.h"

#include <openvdb/openvdb.h>

#include <vector>

namespace grid
{
struct RefinementTrees
{
    std::vector<openvdb::MaskTree> level;
};

namespace
{
openvdb::Coord coord(const Index3& i)
{
    return {i[0], i[1], i[2]};
}
} // namespace

Refinement::Refinement(int levels) : levels_(levels), trees_(std::make_shared<RefinementTrees>())
{
    CLEAVE_EXPECTS(levels >= 1);
    trees_->level.resize(static_cast<std::size_t>(levels));
}

void Refinement::subdivide(int level, const Index3& cell)
{
    CLEAVE_EXPECTS(level >= 0 && level < levels_ - 1);
    RefinementTrees& trees = own();
    openvdb::Coord c = coord(cell);
    for (int l = level; l >= 0; --l, c = openvdb::Coord(c.x() >> 1, c.y() >> 1, c.z() >> 1))
        trees.level[static_cast<std::size_t>(l)].setValueOn(c);
}

RefinementTrees& Refinement::own()
{
    if (trees_.use_count() > 1) trees_ = std::make_shared<RefinementTrees>(*trees_);
    return *trees_;
}

bool Refinement::subdivided(int level, const Index3& cell) const
{
    return trees_->level[static_cast<std::size_t>(level)].isValueOn(coord(cell));
}

void Refinement::balance()
{
    RefinementTrees& trees = own();
    for (int l = levels_ - 2; l >= 1; --l) {
        openvdb::MaskTree& coarser = trees.level[static_cast<std::size_t>(l - 1)];
        for (auto it = trees.level[static_cast<std::size_t>(l)].cbeginValueOn(); it; ++it) {
            const openvdb::Coord c = it.getCoord();
            for (int a = -1; a <= 1; ++a)
                for (int b = -1; b <= 1; ++b)
                    for (int d = -1; d <= 1; ++d)
                        coarser.setValueOn(openvdb::Coord((c.x() + a) >> 1, (c.y() + b) >> 1, (c.z() + d) >> 1));
        }
    }
}

CellKey Refinement::locate(const Vec3& scaled) const
{
    for (int l = 0;; ++l) {
        const Index3 cell = cell_at(scaled, l);
        if (l + 1 >= levels_ || !subdivided(l, cell)) return {l, cell};
    }
}
} // namespace grid
