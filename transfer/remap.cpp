#include "core/parallel.h"
#include "grid/walls.h"
#include "transfer/each_stray.h"
#include "transfer/flip.h"
#include "transfer/gimp_passes.h"
#include "transfer/interface_affine.h"
#include "transfer/passes.h"
#include "transfer/scatter_cell.h"
#include "transfer/scatter_leaf.h"

#include <algorithm>
#include <optional>

namespace transfer
{
namespace
{
/// Update the velocity (and affine matrix) of a chunk; the velocity is returned.
template <Transfer T>
[[gnu::always_inline]] inline core::Vec<Lanes>
remapped(const PassOptions& options, const CellFrame& frame, const CellField& field, const HangingSlopes* masters,
         const core::Vec<Lanes>& x, LaneMask here, std::size_t p, int count, particles::Particles& particles)
{
    const LocalPosition<Lanes> at = local_position(frame, x);
    core::Vec<Lanes> velocity;
    core::Mat<Lanes> affine;
    for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        const Lanes old = load(particles.velocity[axis], p, count);
        core::Vec<Lanes> slope{};
        const Lanes grid_velocity = value_and_slopes(field, velocity_column + a, at, slope[0], slope[1], slope[2]);
        Lanes fresh = grid_velocity;
        if constexpr (T == Transfer::flip) {
            fresh = flip_velocity(options.pic_fraction, old, value(field, change_column + a, at), grid_velocity);
        } else {
            for (int b = 0; b < 3; ++b) affine(a, b) = Lanes(frame.per_spacing) * slope[b];
        }
        velocity[a] = core::select(here, fresh, old);
        store(velocity[a], particles.velocity[axis], p, count);
    }
    if constexpr (T == Transfer::apic) {
        if (masters != nullptr) affine = through_masters(*masters, affine, at, frame.per_spacing);
        store_affine({p, count, here, affine}, particles);
    }
    return velocity;
}

/// Update the velocity (and affine matrix) of the particles [begin, end) that are served, and scatter their momentum.
/// @tparam AtHome  all_at_home(particles, begin, end)
/// @param masters  of the cell's hanging corners; null if it has none
template <Formulation F, Transfer T, bool AtHome>
void remap_cell(const PassOptions& options, const CellFrame& frame, Visitors visitors, const HangingSlopes* masters,
                const grid::NodeMotion* motion, std::size_t begin, std::size_t end, particles::Particles& particles,
                grid::NodeSum* tile)
{
    CellField field;
    read_cell(motion + frame.node, field);
    Staged<group_size<AtHome>> staged;
    if constexpr (AtHome) end = begin + plain_count(begin, end);
    for (std::size_t first = begin; first < end; first += group_size<AtHome>) {
        const std::size_t last = AtHome ? end : std::min(end, first + group_size<AtHome>);
        for (std::size_t p = first; p < last; p += Lanes::lanes) {
            const int count = AtHome ? Lanes::lanes : static_cast<int>(std::min<std::size_t>(Lanes::lanes, last - p));
            const int at = static_cast<int>(p - first);
            const LaneMask here = present<F, AtHome>(visitors, particles, p, count);
            const auto x = load_all<core::Vec<Lanes>>(weight_position<F>(particles), p, count);
            const core::Vec<Lanes> velocity = remapped<T>(options, frame, field, masters, x, here, p, count, particles);
            stage_momentum(frame, x, load(particles.mass, p, count), velocity, at, staged);
            if constexpr (!AtHome)
                for (int i = 0; i < count; ++i) staged.here[at + i] = here[i] ? 1 : 0;
        }
        add_staged<F, T, AtHome, true>(frame, staged, static_cast<int>(last - first), particles, first, tile);
    }
}

/// Slopes between the masters of a cell's hanging corners; nothing if none hangs, and for FLIP.
/// @param hanging  of the leaf
template <Transfer T>
std::optional<HangingSlopes> slopes_of(const grid::Levels& levels, const HangingRange& hanging, std::size_t leaf,
                                       int cell)
{
    if constexpr (T == Transfer::apic) {
        const HangingRange range = narrowed(hanging, leaf * grid::leaf_cells + static_cast<std::size_t>(cell));
        if (range.begin != range.end) return read_slopes(levels, *range.face, range.begin);
    }
    return {};
}

template <Transfer T>
HangingRange hanging_for(const grid::Levels& levels, std::size_t leaf)
{
    if constexpr (T == Transfer::apic) return hanging_cells(levels, leaf);
    return {};
}
} // namespace

void remap_momentum(const PassOptions& options, Strays& strays, particles::Particles& particles, grid::Levels& levels)
{
    if (uses_boxes(options)) return remap_boxes(options, strays, particles, levels);
    with_scheme(options, [&]<Formulation F, Transfer T>() {
        core::parallel_for(levels.leaves.size(), [&](std::size_t n) {
            grid::NodeSum* tile = levels.sums(n);
            grid::for_nodes(levels.used[n], grid::leaf_side, [&](int node) { tile[node].momentum = {}; });
            const std::uint32_t* start = levels.cell_start.data() + n * grid::leaf_cells;
            const LeafFrame frame = leaf_frame(levels, n);
            const HangingRange hanging = hanging_for<T>(levels, n);
            for (int c = 0; c < grid::leaf_cells; ++c) {
                if (start[c] == start[c + 1]) continue;
                const std::optional<HangingSlopes> masters = slopes_of<T>(levels, hanging, n, c);
                const auto remap = [&]<bool AtHome>() {
                    remap_cell<F, T, AtHome>(options, cell_frame(frame, c), Visitors::residents,
                                             masters ? &*masters : nullptr, levels.motions(n), start[c], start[c + 1],
                                             particles, tile);
                };
                all_at_home(particles, start[c], start[c + 1]) ? remap.template operator()<true>()
                                                               : remap.template operator()<false>();
            }
            scatter_affine(options, particles, n, levels);
        });
        for_each_stray(strays, [&](std::uint32_t s, std::size_t leaf, std::uint32_t p) {
            const HangingRange hanging = hanging_for<T>(levels, leaf);
            const std::optional<HangingSlopes> masters = slopes_of<T>(levels, hanging, leaf, strays.cell[s]);
            remap_cell<F, T, false>(options, frame_of_stray(levels, strays, s), Visitors::stray,
                                    masters ? &*masters : nullptr, levels.motions(leaf), p, p + 1, particles,
                                    levels.sums(leaf));
        });
    });
    scatter_stray_affine(options, strays, particles, levels);
}
} // namespace transfer
