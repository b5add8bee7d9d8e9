/// Which cells of each level are subdivided: the sets R_l of methods.md A.3.1, kept strongly 2:1 balanced.
///
/// Cells are named by the node index of their lower corner. A location belongs to the leaf cell found by descending
/// from level 0 while the cell is subdivided.
#pragma once

#include "core/real.h"

#include <memory>

namespace grid
{
/// Mask trees of the subdivided cells, one per level; defined in refinement.cpp.
struct RefinementTrees;

/// A cell (or node) of one level.
struct CellKey
{
    int level = 0;
    Index3 cell = Index3::Zero();
};

/// Cell of a level that holds the point with level-0 lattice coordinate `scaled`.
inline Index3 cell_at(const Vec3& scaled, int level)
{
    return (scaled * static_cast<Real>(1 << level)).array().floor().matrix().cast<int>();
}

inline Index3 parent(const Index3& cell)
{
    return {cell[0] >> 1, cell[1] >> 1, cell[2] >> 1};
}

class Refinement
{
public:
    /// Nothing subdivided; `levels` >= 1.
    explicit Refinement(int levels = 1);

    int levels() const { return levels_; }
    /// Subdivide `cell` of `level` (level < levels - 1), and every coarser cell that contains it.
    void subdivide(int level, const Index3& cell);
    bool subdivided(int level, const Index3& cell) const;
    /// Enforce R_{l-1} >= parent(dilate_26(R_l)), finest level first: neighbouring leaf cells, also across edges and
    /// corners, then differ by at most one level.
    void balance();
    /// Leaf cell that holds the point with level-0 lattice coordinate `scaled` = (x - origin) / spacing0.
    CellKey locate(const Vec3& scaled) const;

private:
    /// The trees, as the only one who holds them: a copy keeps what it has.
    RefinementTrees& own();

    int levels_;
    std::shared_ptr<RefinementTrees> trees_;
};
} // namespace grid
