/// Boxes read velocities off the grid: those of a chunk together if they share their cells, else one by one, and lanes
/// of particles are filled from what they read.
#pragma once

#include "transfer/gimp_affine.h"
#include "transfer/gimp_lines.h"

namespace transfer
{
/// The leaf whose particles gather, and the cut boxes among them. Boxes are asked for in storage order.
struct BoxSource
{
    const grid::Levels& levels;
    const ReachMap& map;
    const grid::NodeMotion* node; // of the reach tile
    const CutBoxes& cut;
    std::size_t next = 0; // in `cut`
};

namespace detail
{
/// Lines and moments of the next cut box.
template <BoxRead Read>
[[gnu::noinline]] void gather_cut(BoxSource& source, NodeLine* out, BoxMoments& moments)
{
    std::fill_n(out, box_lines(Read), NodeLine(Real(0)));
    const std::size_t box = source.next++;
    for (std::size_t n = source.cut.part_start[box]; n < source.cut.part_start[box + 1]; ++n) {
        const BoxPart& part = source.cut.part[n];
        gather_part<Read>(part, source.levels.motions(static_cast<std::size_t>(part.leaf)), out);
        if constexpr (Read == BoxRead::affine) add_moments(part, source.levels, moments);
    }
}

[[gnu::always_inline]] inline Lanes box_inertia(const BoxWeights& w, int axis)
{
    Lanes inertia(Real(0));
    for (int n = 0; n < 3; ++n) {
        const Lanes arm = Lanes::load(w.arm[axis][n]);
        inertia += Lanes::load(w.weight[axis][n]) * arm * arm;
    }
    return inertia;
}
} // namespace detail

/// Read the first `count` boxes of `weights` one by one. A box that the map does not serve is the source's next cut
/// one.
template <BoxRead Read>
[[gnu::always_inline]] inline void gather_each(const BoxWeights& weights, int count, BoxSource& source, BoxChunk& chunk)
{
    constexpr bool affine = Read == BoxRead::affine;
    NodeLine line[BoxChunk::lanes][box_lines(Read)];
    alignas(64) Real inertia[3][BoxChunk::lanes] = {};
    if constexpr (affine)
        for (int a = 0; a < 3; ++a) detail::box_inertia(weights, a).store(inertia[a]);
    core::Mat<Real> hanging[BoxChunk::lanes];
    bool any_hanging = false;
    for (int i = 0; i < BoxChunk::lanes; ++i) {
        NodeLine* out = line[i];
        if (i >= count) { // computed with, never stored
            std::fill_n(out, box_lines(Read), NodeLine(Real(0)));
            continue;
        }
        if (served(source.map, weights, i)) {
            gather_walks<Read>[static_cast<std::size_t>(weights.code(i))](weights, i, source.node + weights.node(i),
                                                                          out);
        } else {
            BoxMoments moments;
            detail::gather_cut<Read>(source, out, moments);
            if constexpr (affine) {
                for (std::size_t a = 0; a < 3; ++a) inertia[a][i] = moments.inertia[a];
                if (!any_hanging) std::fill_n(hanging, BoxChunk::lanes, core::Mat<Real>{});
                any_hanging = true;
                hanging[i] = moments.hanging;
            }
        }
    }
    Lanes read[box_lines(Read)][8];
    for (int n = 0; n < box_lines(Read); ++n)
        lines_to_lanes([&](int i, int place) { return line[i][n].part[place / NodeLine::piece]; }, read[n]);
    for (int q = 0; q < 8; ++q) read[0][q].store(chunk.value[q]);
    if constexpr (Read != BoxRead::values) {
        constexpr int wanted = Read == BoxRead::change_slopes ? change_column : velocity_column;
        for (int a = 0; a < 3; ++a) {
            read[1][wanted + a].store(chunk.gradient[3 * a]);
            read[2][a].store(chunk.gradient[3 * a + 1]);
            if constexpr (affine)
                read[3][a].store(chunk.gradient[3 * a + 2]);
            else
                read[2][4 + a].store(chunk.gradient[3 * a + 2]);
        }
    }
    if constexpr (affine)
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) {
                Lanes moment = read[1 + b][4 + a];
                if (any_hanging)
                    for (int i = 0; i < count; ++i) moment.v[i] += hanging[i](a, b);
                (moment / Lanes::load(inertia[b])).store(chunk.affine[3 * a + b]);
            }
}

/// Read boxes that share their cells.
template <BoxRead Read>
[[gnu::always_inline]] inline void gather_together(const SharedBoxes& shared, const BoxSource& source, BoxChunk& chunk)
{
    shared_gathers<Read>[static_cast<std::size_t>(shared.code)](shared, source.node + shared.node, chunk);
}

/// Boxes that do not share their cells; out of the way, so that the others keep their numbers in registers.
template <BoxRead Read>
[[gnu::noinline]] void gather_apart(const BoxFrame& frame, const particles::Particles& particles, std::size_t begin,
                                    int count, BoxSource& source, BoxChunk& chunk)
{
    BoxWeights weights;
    box_weights<Read == BoxRead::affine>(frame, box_axes(frame, particles, begin, count), weights);
    gather_each<Read>(weights, count, source, chunk);
}

/// Read the boxes of the particles [begin, begin + count).
template <BoxRead Read>
[[gnu::always_inline]] inline void gather_boxes(const BoxFrame& frame, const particles::Particles& particles,
                                                std::size_t begin, int count, BoxSource& source, BoxChunk& chunk)
{
    SharedBoxes shared;
    if (share_cells<Read == BoxRead::affine>(source.map, frame, box_axes(frame, particles, begin, count), count,
                                             shared))
        gather_together<Read>(shared, source, chunk);
    else
        gather_apart<Read>(frame, particles, begin, count, source, chunk);
}

[[gnu::always_inline]] inline core::Mat<Lanes> matrix_lanes(const Real (&rows)[9][BoxChunk::lanes])
{
    core::Mat<Lanes> m;
    for (std::size_t n = 0; n < 9; ++n) m.m[n] = Lanes::load(rows[n]);
    return m;
}
} // namespace transfer
