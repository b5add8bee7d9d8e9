#include "transfer/lattice.h"

#include "core/huge_pages.h"
#include "core/parallel.h"
#include "transfer/chunk.h"

#include <atomic>
#include <cmath>

namespace transfer
{
namespace
{
LocalPosition<Real> rest_place(const CellFrame& cell, const particles::Particles& particles, std::size_t p)
{
    const auto& x = particles.rest_position;
    return local_position(cell, core::Vec<Real>{{x[0][p], x[1][p], x[2][p]}});
}

/// Slot of a rest position in its cell, or -1 if it is not one of the eight points.
int slot_of(const CellFrame& cell, const particles::Particles& particles, std::size_t p)
{
    constexpr Real tolerance = 1e-6;
    const LocalPosition<Real> at = rest_place(cell, particles, p);
    int slot = 0;
    for (const Real local : {at.xi, at.eta, at.zeta}) {
        const int upper = local > Real(0.5) ? 1 : 0;
        if (std::abs(local - (upper ? Real(0.75) : Real(0.25))) > tolerance) return -1;
        slot = 2 * slot + upper;
    }
    return slot;
}

/// Bits of the slots of one cell's particles; 0 if they are not on slots, each on its own and in order.
std::uint8_t filled_slots(const CellFrame& cell, std::size_t begin, std::size_t end,
                          const particles::Particles& particles)
{
    int last = -1;
    unsigned bits = 0;
    for (std::size_t p = begin; p < end; ++p) {
        const int slot = slot_of(cell, particles, p);
        if (slot <= last) return 0;
        bits |= 1u << slot;
        last = slot;
    }
    return static_cast<std::uint8_t>(bits);
}

/// All particles on slots; the masks go to `filled`, [leaf][512].
bool fits(const particles::Particles& particles, const grid::Levels& levels, std::vector<std::uint8_t>& filled)
{
    filled.assign(levels.leaves.size() * grid::leaf_cells, 0);
    std::atomic<bool> all = true;
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        const std::uint32_t* start = levels.cell_start.data() + n * grid::leaf_cells;
        const LeafFrame frame = leaf_frame(levels, n);
        for (int c = 0; c < grid::leaf_cells; ++c) {
            if (start[c] == start[c + 1]) continue;
            const std::uint8_t slots_of_cell = filled_slots(cell_frame(frame, c), start[c], start[c + 1], particles);
            filled[n * grid::leaf_cells + static_cast<std::size_t>(c)] = slots_of_cell;
            if (slots_of_cell == 0) all = false;
        }
    });
    return all;
}

std::int32_t only_material(const particles::Particles& particles, std::size_t begin, std::size_t end)
{
    for (std::size_t p = begin; p < end; ++p)
        if (particles.material[p] != particles.material[begin]) return Lattice::mixed;
    return begin < end ? particles.material[begin] : 0;
}

/// Cells of the leaves, in cell order, dealt to blocks; a leaf begins a block.
template <class T>
void deal_cells(const grid::Levels& levels, const std::vector<std::uint8_t>& filled, BlockTable<T>& table)
{
    table = {};
    for (std::size_t n = 0; n < levels.leaves.size(); ++n) {
        table.start.push_back(static_cast<std::uint32_t>(table.block.size()));
        const std::uint32_t* start = levels.cell_start.data() + n * grid::leaf_cells;
        for (int c = 0; c < grid::leaf_cells; ++c) {
            if (start[c] == start[c + 1]) continue;
            if (table.block.size() == table.start.back() || table.block.back().count == block_lanes<T>)
                table.block.emplace_back();
            table.block.back().add(c, start[c], filled[n * grid::leaf_cells + static_cast<std::size_t>(c)]);
        }
    }
    table.start.push_back(static_cast<std::uint32_t>(table.block.size()));
}

/// Call visit(slots of a state, particle column) for every quantity the blocks hold.
template <class State, class Particles, class Visit>
void for_quantities(State& state, Particles& particles, const Visit& visit)
{
    visit(state.rest_volume, particles.rest_volume);
    visit(state.eq_plastic_strain, particles.eq_plastic_strain);
    for (std::size_t n = 0; n < 6; ++n) visit(state.stress[n], particles.stress[n]);
}

template <class T>
void pack(const particles::Particles& particles, BlockTable<T>& table)
{
    core::reserve_huge_pages(table.block.size(), table.state);
    table.state.resize(table.block.size());
    core::parallel_for(table.block.size(), [&](std::size_t b) {
        const CellBlock<T>& block = table.block[b];
        for_quantities(table.state[b], particles, [&](auto& to, const particles::Column& from) {
            for (int s = 0; s < slots; ++s)
                for (int i = 0; i < block.lanes; ++i)
                    to[static_cast<std::size_t>(s)][static_cast<std::size_t>(i)] =
                        block.has(i, s) ? static_cast<T>(from[block.particle(i, s)]) : T(0);
        });
    });
}

template <class T>
void unpack(const BlockTable<T>& table, particles::Particles& particles)
{
    core::parallel_for(table.block.size(), [&](std::size_t b) {
        const CellBlock<T>& block = table.block[b];
        for_quantities(table.state[b], particles, [&](const auto& from, particles::Column& to) {
            if (&to == &particles.rest_volume) return; // never changes, and the particles keep all its digits
            for (int s = 0; s < slots; ++s)
                for (int i = 0; i < block.count; ++i)
                    if (block.has(i, s))
                        to[block.particle(i, s)] =
                            static_cast<Real>(from[static_cast<std::size_t>(s)][static_cast<std::size_t>(i)]);
        });
    });
}

/// Columns that nodes and blocks make superfluous.
template <class Visit>
void for_dropped(particles::Particles& particles, const Visit& visit)
{
    for (particles::Column& column : particles.position) visit(column);
    for (particles::Column& column : particles.velocity) visit(column);
    for (particles::Column& column : particles.deformation_gradient) visit(column);
    for (particles::Column& column : particles.stress) visit(column);
    visit(particles.eq_plastic_strain);
}

/// Position, velocity and deformation gradient at one particle, with its own weights: not in a hurry.
void find_motion(const grid::NodeMotion* tile, const CellFrame& frame, std::size_t p, particles::Particles& particles)
{
    const LocalPosition<Real> at = rest_place(frame, particles, p);
    CellField field;
    read_cell(tile + frame.node, field);
    for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        Real slope[3];
        const Real displacement = value_and_slopes(field, change_column + a, at, slope[0], slope[1], slope[2]);
        particles.position[axis][p] = particles.rest_position[axis][p] + displacement;
        particles.velocity[axis][p] = value(field, velocity_column + a, at);
        for (std::size_t b = 0; b < 3; ++b)
            particles.deformation_gradient[3 * axis + b][p] = (axis == b ? 1 : 0) + frame.per_spacing * slope[b];
    }
}
} // namespace

bool enter_lattice(Precision precision, const grid::Levels& levels, particles::Particles& particles, Lattice& lattice)
{
    std::vector<std::uint8_t> filled;
    if (!fits(particles, levels, filled)) return false;
    const std::size_t leaves = levels.leaves.size();
    lattice.cracked.assign(leaves * grid::leaf_cells, 0);
    for (std::size_t place = 0; place < lattice.cracked.size(); ++place)
        for (std::uint32_t p = levels.cell_start[place]; p < levels.cell_start[place + 1]; ++p)
            if (particles.crack[p] >= 0) lattice.cracked[place] = 1;
    lattice.material.clear();
    for (std::size_t n = 0; n < leaves; ++n)
        lattice.material.push_back(only_material(particles, levels.cell_start[n * grid::leaf_cells],
                                                 levels.cell_start[(n + 1) * grid::leaf_cells]));
    lattice.onset.assign(leaves, {});
    lattice.near.assign(leaves, {});
    if (precision == Precision::mixed)
        lattice.blocks = BlockTable<float>{};
    else
        lattice.blocks = BlockTable<Real>{};
    std::visit(
        [&](auto& table) {
            deal_cells(levels, filled, table);
            pack(particles, table);
        },
        lattice.blocks);
    drop_columns(particles);
    return true;
}

Vec3 displacement_of(const particles::Particles& particles, const grid::Levels& levels, std::size_t particle)
{
    const auto after = std::upper_bound(levels.cell_start.begin(), levels.cell_start.end(), particle);
    const auto place = static_cast<std::size_t>(after - levels.cell_start.begin() - 1);
    const std::size_t leaf = place / grid::leaf_cells;
    const CellFrame frame = cell_frame(leaf_frame(levels, leaf), static_cast<int>(place % grid::leaf_cells));
    CellField field;
    read_cell(levels.motions(leaf) + frame.node, field);
    const LocalPosition<Real> at = rest_place(frame, particles, particle);
    return {value(field, change_column, at), value(field, change_column + 1, at), value(field, change_column + 2, at)};
}

void fill_columns(const grid::Levels& levels, const Lattice& lattice, particles::Particles& particles)
{
    for_dropped(particles, [&](particles::Column& column) { column.resize(particles.size()); });
    core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
        const std::uint32_t* start = levels.cell_start.data() + n * grid::leaf_cells;
        const LeafFrame frame = leaf_frame(levels, n);
        for (int c = 0; c < grid::leaf_cells; ++c)
            for (std::uint32_t p = start[c]; p < start[c + 1]; ++p)
                find_motion(levels.motions(n), cell_frame(frame, c), p, particles);
    });
    std::visit([&](const auto& table) { unpack(table, particles); }, lattice.blocks);
}

void drop_columns(particles::Particles& particles)
{
    for_dropped(particles, [](particles::Column& column) { particles::Column().swap(column); });
}
} // namespace transfer
