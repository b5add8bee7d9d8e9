/// A set of cells cut into boxes without gaps and overlaps, as block-structured formats want it.
#pragma once

#include "core/real.h"

#include <cstddef>
#include <span>
#include <vector>

namespace io
{
/// Cells lower .. upper, both included.
struct CellBox
{
    Index3 lower = Index3::Zero();
    Index3 upper = Index3::Zero();
};

/// Join the cells to runs along z, equal runs to sheets along y, equal sheets to boxes along x.
///
/// Every cell is in exactly one box and no box holds anything else. Not the smallest number of boxes, which is hard to
/// find: a plate of constant thickness with holes needs about one per step of its outline.
/// @param cells  all different, any order
/// @return boxes sorted by their lower corners: x, then y, then z
/// @cost  n log n
std::vector<CellBox> cut_into_boxes(std::span<const Index3> cells);

/// Numbers of the cells in the order of the boxes, x fastest inside a box.
/// @param cells  sorted by x, then y, then z; `boxes` are cut from them
std::vector<std::size_t> box_order(std::span<const Index3> cells, const std::vector<CellBox>& boxes);
} // namespace io
