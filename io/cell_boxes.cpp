#include "io/cell_boxes.h"

#include "io/cell_order.h"

#include <algorithm>
#include <tuple>

namespace io
{
namespace
{
/// Extent across `axis`: what two boxes must share to be joined along it.
auto section(const CellBox& box, int axis)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    return std::tuple(box.lower[u], box.upper[u], box.lower[v], box.upper[v]);
}

/// Join boxes with the same section that touch along `axis`.
void join_along(int axis, std::vector<CellBox>& boxes)
{
    std::sort(boxes.begin(), boxes.end(), [&](const CellBox& a, const CellBox& b) {
        return std::tuple(section(a, axis), a.lower[axis]) < std::tuple(section(b, axis), b.lower[axis]);
    });
    std::size_t last = 0;
    for (std::size_t i = 1; i < boxes.size(); ++i) {
        CellBox& open = boxes[last];
        if (section(open, axis) == section(boxes[i], axis) && open.upper[axis] + 1 == boxes[i].lower[axis])
            open.upper[axis] = boxes[i].upper[axis];
        else
            boxes[++last] = boxes[i];
    }
    if (!boxes.empty()) boxes.resize(last + 1);
}
} // namespace

std::vector<CellBox> cut_into_boxes(std::span<const Index3> cells)
{
    std::vector<CellBox> boxes;
    boxes.reserve(cells.size());
    for (const Index3& cell : cells) boxes.push_back({cell, cell});
    for (const int axis : {2, 1, 0}) join_along(axis, boxes);
    std::sort(boxes.begin(), boxes.end(),
              [](const CellBox& a, const CellBox& b) { return cell_key(a.lower) < cell_key(b.lower); });
    return boxes;
}

std::vector<std::size_t> box_order(std::span<const Index3> cells, const std::vector<CellBox>& boxes)
{
    std::vector<std::size_t> order;
    order.reserve(cells.size());
    std::vector<std::size_t> run; // first cell of every run along z, x fastest
    for (const CellBox& box : boxes) {
        run.clear();
        for (int y = box.lower.y(); y <= box.upper.y(); ++y)
            for (int x = box.lower.x(); x <= box.upper.x(); ++x)
                run.push_back(find_cell(cells, Index3(x, y, box.lower.z())));
        const auto height = static_cast<std::size_t>(box.upper.z() - box.lower.z() + 1);
        for (std::size_t z = 0; z < height; ++z)
            for (const std::size_t first : run) order.push_back(first + z);
    }
    return order;
}
} // namespace io
