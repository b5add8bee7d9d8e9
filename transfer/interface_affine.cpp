#include "transfer/interface_affine.h"

#include "core/parallel.h"
#include "transfer/advance_cell.h"
#include "transfer/cell_sum.h"
#include "transfer/each_stray.h"

#include <algorithm>

namespace transfer
{
namespace
{
int cell_of(const grid::LevelInterface& face, std::size_t c)
{
    return static_cast<int>(face.hanging.slot[c] % grid::leaf_cells);
}

HangingRange cell_of_stray(const grid::Levels& levels, const Strays& strays, std::size_t stray)
{
    const auto leaf = static_cast<std::size_t>(strays.leaf[stray]);
    const auto cell = static_cast<std::size_t>(strays.cell[stray]);
    return narrowed(hanging_cells(levels, leaf), leaf * grid::leaf_cells + cell);
}

/// The particles a visit to a cell looks at.
struct Visit
{
    Visitors visitors;
    std::size_t begin, end;
};

template <Formulation F>
void affine_of_cell(const grid::Levels& levels, std::size_t leaf, const grid::LevelInterface& face, std::size_t c,
                    const Visit& visit, const particles::Particles& particles, std::vector<AffineChunk>& chunks)
{
    const CellFrame frame = cell_frame(leaf_frame(levels, leaf), cell_of(face, c));
    const HangingSlopes masters = read_slopes(levels, face, c);
    CellField field;
    read_cell(levels.motions(leaf) + frame.node, field);
    for (std::size_t p = visit.begin; p < visit.end; p += Lanes::lanes) {
        const int count = static_cast<int>(std::min<std::size_t>(Lanes::lanes, visit.end - p));
        const auto x = load_all<core::Vec<Lanes>>(weight_position<F>(particles), p, count);
        const LocalPosition<Lanes> at = local_position(frame, x);
        core::Vec<Lanes> velocity;
        const core::Mat<Lanes> g = detail::gradient(field, velocity_column, at, Lanes(frame.per_spacing), velocity);
        chunks.push_back({p, count, present<F>(visit.visitors, particles, p, count),
                          through_masters(masters, g, at, frame.per_spacing)});
    }
}

/// One lane per corner.
using CornerLanes = core::Pack<Real, 8>;

/// Nine entries of m C for the eight corners.
struct AffineSum
{
    CornerLanes entry[9];
};

template <Formulation F>
void add_cell(const CellFrame& frame, const Visit& visit, const particles::Particles& particles, AffineSum& sum)
{
    for (std::size_t p = visit.begin; p < visit.end; p += Lanes::lanes) {
        const int count = static_cast<int>(std::min<std::size_t>(Lanes::lanes, visit.end - p));
        const auto x = load_all<core::Vec<Lanes>>(weight_position<F>(particles), p, count);
        const LocalPosition<Lanes> at = local_position(frame, x);
        const LaneMask here = present<F>(visit.visitors, particles, p, count);
        for (int i = 0; i < count; ++i) {
            if (!here[i]) continue;
            const std::size_t q = p + static_cast<std::size_t>(i);
            const CornerLanes w =
                CornerLanes(particles.mass[q]) * corner_weights(corners_from<8>(0), at.xi[i], at.eta[i], at.zeta[i]).w;
            for (std::size_t n = 0; n < 9; ++n) sum.entry[n] += w * CornerLanes(particles.affine[n][q]);
        }
    }
}

AffineSum load_sum(const grid::CornerAffine& from)
{
    AffineSum sum;
    for (std::size_t n = 0; n < 9; ++n) sum.entry[n] = CornerLanes::load(from.entry[n].data());
    return sum;
}

void store_sum(const AffineSum& sum, grid::CornerAffine& to)
{
    for (std::size_t n = 0; n < 9; ++n) sum.entry[n].store(to.entry[n].data());
}

/// Where the scatter may write: the interface a range was found on.
grid::LevelInterface& interface_of(grid::Levels& levels, std::size_t leaf)
{
    return levels.interface[static_cast<std::size_t>(levels.leaves[leaf].level - 1)];
}

/// Does the step make new matrices while particles advance?
bool wanted(const PassOptions& options)
{
    return options.transfer == Transfer::apic && options.stress_update == StressUpdate::usl;
}

/// Call `body.template operator()<F>()` for the options' formulation.
template <class Body>
void with_formulation(const PassOptions& options, const Body& body)
{
    options.formulation == Formulation::total ? body.template operator()<Formulation::total>()
                                              : body.template operator()<Formulation::updated>();
}
} // namespace

std::vector<AffineChunk> affine_of_residents(const PassOptions& options, const grid::Levels& levels, std::size_t leaf,
                                             const particles::Particles& particles)
{
    std::vector<AffineChunk> chunks;
    if (!wanted(options)) return chunks;
    const HangingRange range = hanging_cells(levels, leaf);
    chunks.reserve(2 * (range.end - range.begin));
    with_formulation(options, [&]<Formulation F>() {
        for (std::size_t c = range.begin; c < range.end; ++c) {
            const std::uint32_t* start = levels.cell_start.data() + range.face->hanging.slot[c];
            affine_of_cell<F>(levels, leaf, *range.face, c, {Visitors::residents, start[0], start[1]}, particles,
                              chunks);
        }
    });
    return chunks;
}

std::vector<AffineChunk> affine_of_stray(const PassOptions& options, const grid::Levels& levels, const Strays& strays,
                                         std::size_t stray, const particles::Particles& particles)
{
    std::vector<AffineChunk> chunks;
    if (!wanted(options)) return chunks;
    const auto leaf = static_cast<std::size_t>(strays.leaf[stray]);
    const HangingRange range = cell_of_stray(levels, strays, stray);
    const std::size_t p = strays.particle[stray];
    for (std::size_t c = range.begin; c < range.end; ++c)
        affine_of_cell<Formulation::updated>(levels, leaf, *range.face, c, {Visitors::stray, p, p + 1}, particles,
                                             chunks);
    return chunks;
}

void store_affine(const std::vector<AffineChunk>& chunks, particles::Particles& particles)
{
    for (const AffineChunk& chunk : chunks) store_affine(chunk, particles);
}

void scatter_affine(const PassOptions& options, const particles::Particles& particles, std::size_t leaf,
                    grid::Levels& levels)
{
    if (options.transfer != Transfer::apic) return;
    const HangingRange range = hanging_cells(levels, leaf);
    with_formulation(options, [&]<Formulation F>() {
        for (std::size_t c = range.begin; c < range.end; ++c) {
            const std::uint32_t* start = levels.cell_start.data() + range.face->hanging.slot[c];
            AffineSum sum;
            for (CornerLanes& entry : sum.entry) entry = CornerLanes(Real(0));
            add_cell<F>(cell_frame(leaf_frame(levels, leaf), cell_of(*range.face, c)),
                        {Visitors::residents, start[0], start[1]}, particles, sum);
            store_sum(sum, interface_of(levels, leaf).hanging.affine[c]);
        }
    });
}

void scatter_stray_affine(const PassOptions& options, const Strays& strays, const particles::Particles& particles,
                          grid::Levels& levels)
{
    if (options.transfer != Transfer::apic) return;
    for_each_stray(strays, [&](std::uint32_t s, std::size_t leaf, std::size_t p) {
        const HangingRange range = cell_of_stray(levels, strays, s);
        if (range.begin == range.end) return;
        grid::CornerAffine& target = interface_of(levels, leaf).hanging.affine[range.begin];
        AffineSum sum = load_sum(target);
        add_cell<Formulation::updated>(frame_of_stray(levels, strays, s), {Visitors::stray, p, p + 1}, particles, sum);
        store_sum(sum, target);
    });
}
} // namespace transfer
