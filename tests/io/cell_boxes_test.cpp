#include "io/cell_boxes.h"

#include "io/cell_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace
{
using Cells = std::vector<Index3>;

template <class Inside>
Cells cells_where(int side, Inside inside)
{
    Cells cells;
    for (int x = -side; x < side; ++x)
        for (int y = -side; y < side; ++y)
            for (int z = -side; z < side; ++z)
                if (inside(Index3(x, y, z))) cells.emplace_back(x, y, z);
    return cells;
}

std::size_t volume(const io::CellBox& box)
{
    const Index3 size = box.upper - box.lower + Index3::Ones();
    return static_cast<std::size_t>(size.prod());
}
} // namespace

TEST(CellBoxes, HoldEveryCellOnceAndNothingElse)
{
    std::mt19937 random(7);
    const Cells cells = cells_where(6, [&](const Index3&) { return random() % 3 != 0; });
    const std::vector<io::CellBox> boxes = io::cut_into_boxes(cells);
    std::set<std::tuple<int, int, int>> found;
    std::size_t total = 0;
    for (const io::CellBox& box : boxes) {
        total += volume(box);
        for (int x = box.lower.x(); x <= box.upper.x(); ++x)
            for (int y = box.lower.y(); y <= box.upper.y(); ++y)
                for (int z = box.lower.z(); z <= box.upper.z(); ++z) found.insert({x, y, z});
    }
    EXPECT_EQ(total, cells.size());
    std::set<std::tuple<int, int, int>> expected;
    for (const Index3& cell : cells) expected.insert(io::cell_key(cell));
    EXPECT_EQ(found, expected);
    EXPECT_TRUE(io::cut_into_boxes({}).empty());
}

TEST(CellBoxes, AreFewForAPlateWithAHole)
{
    const Cells whole = cells_where(8, [](const Index3&) { return true; });
    EXPECT_EQ(io::cut_into_boxes(whole).size(), 1u);
    const Cells plate = cells_where(8, [](const Index3& c) {
        return c.z() >= 0 && c.z() < 5 && (c.x() < -2 || c.x() > 2 || c.y() < -2 || c.y() > 2);
    });
    EXPECT_EQ(io::cut_into_boxes(plate).size(), 4u); // before, beside on two sides, behind
}

TEST(CellBoxes, AreStoredWithXFastest)
{
    const Cells cells = cells_where(4, [](const Index3& c) { return c.x() < 1 || c.y() > 1; });
    const std::vector<io::CellBox> boxes = io::cut_into_boxes(cells);
    ASSERT_GT(boxes.size(), 1u);
    Cells expected;
    for (const io::CellBox& box : boxes)
        for (int z = box.lower.z(); z <= box.upper.z(); ++z)
            for (int y = box.lower.y(); y <= box.upper.y(); ++y)
                for (int x = box.lower.x(); x <= box.upper.x(); ++x) expected.emplace_back(x, y, z);
    Cells stored;
    for (const std::size_t c : io::box_order(cells, boxes)) stored.push_back(cells[c]);
    EXPECT_EQ(stored, expected);
}
