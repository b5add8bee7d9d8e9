/// Particles of one cell to its nodes: mass, momentum and internal force.
#pragma once

#include "transfer/cell_sum.h"
#include "transfer/given.h"
#include "transfer/passes.h"

namespace transfer
{
/// Mean pressure of the cell's intact particles, weighted by current volume: the adjoint of averaging their dilatation
/// (methods.md B8), f = - sum V [s grad w + p_mean grad w]. In the total formulation the particles of a cell share
/// every dilatation since the beginning, so their pressures are equal already and no average is needed.
struct CellPressure
{
    Real volume = 0;          // mm^3
    Real pressure_volume = 0; // N mm, sum of volume * mean stress
    Real mean() const { return volume > 0 ? pressure_volume / volume : Real(0); }
};

/// What the node lanes broadcast, one entry per particle, up to Capacity of them.
template <std::size_t Capacity>
struct Staged
{
    alignas(64) Real xi[Capacity], eta[Capacity], zeta[Capacity], mass[Capacity];
    alignas(64) Real momentum[3][Capacity];
    alignas(64) Real stress_volume[9][Capacity]; // symmetric: the first six, as in core::Sym
    std::uint8_t here[Capacity];                 // 1: is served
};

namespace detail
{
/// Place of V sigma, or V0 P, in Staged::stress_volume.
template <Formulation F>
constexpr int flux_place(int a, int b)
{
    return F == Formulation::total ? 3 * a + b : static_cast<int>(core::Sym<Real>::at(a, b));
}

/// V sigma, with the pressure replaced by the cell mean on `averaged` lanes.
[[gnu::always_inline]] inline core::Sym<Lanes> volume_stress(Lanes volume, const core::Sym<Lanes>& stress,
                                                             LaneMask averaged, Real mean_pressure)
{
    // Multiplied last: a product that is subtracted may or may not be fused, depending on what else a kernel that has
    // this inlined does with it, and the two ways to a sum would differ in bits.
    const Lanes excess = Lanes(3 * mean_pressure) - core::trace(stress);
    const Lanes shift = core::select(averaged, excess * Lanes(Real(1) / 3), Lanes(Real(0)));
    core::Sym<Lanes> flux;
    for (int n = 0; n < 6; ++n) flux[n] = volume * (n < 3 ? stress[n] + shift : stress[n]);
    return flux;
}

/// V0 P = V0 J sigma F^{-T} = V0 sigma cof(F).
[[gnu::always_inline]] inline core::Mat<Lanes> volume_piola(Lanes rest_volume, const core::Sym<Lanes>& stress,
                                                            const core::Mat<Lanes>& f)
{
    const core::Mat<Lanes> cof = core::cofactor(f);
    core::Mat<Lanes> m;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            m(i, j) = rest_volume * (stress(i, 0) * cof(0, j) + stress(i, 1) * cof(1, j) + stress(i, 2) * cof(2, j));
    return m;
}

inline void reduce_to_solid(const particles::Particles& particles, std::size_t begin, int count, Lanes& volume)
{
    for (int i = 0; i < count; ++i) {
        const std::int32_t crack = particles.crack[begin + static_cast<std::size_t>(i)];
        if (crack >= 0) volume.v[i] *= solid_share(particles.cracks[static_cast<std::size_t>(crack)]);
    }
}
} // namespace detail

/// Mass and momentum of a chunk, from entry `at` on.
template <std::size_t Capacity>
[[gnu::always_inline]] inline void stage_momentum(const CellFrame& frame, const core::Vec<Lanes>& position, Lanes mass,
                                                  const core::Vec<Lanes>& velocity, int at, Staged<Capacity>& staged)
{
    const LocalPosition<Lanes> local = local_position(frame, position);
    local.xi.store(staged.xi + at);
    local.eta.store(staged.eta + at);
    local.zeta.store(staged.zeta + at);
    mass.store(staged.mass + at);
    for (int a = 0; a < 3; ++a) (mass * velocity[a]).store(staged.momentum[a] + at);
}

/// A chunk, from entry `at` on.
/// @param averaged  lanes that take the cell's mean pressure; updated formulation only
template <Formulation F, std::size_t Capacity>
[[gnu::always_inline]] inline void stage(const CellFrame& frame, const Given& given, LaneMask averaged,
                                         Real mean_pressure, int at, Staged<Capacity>& staged)
{
    stage_momentum(frame, given.position, given.mass, given.velocity, at, staged);
    if constexpr (F == Formulation::total) {
        const core::Mat<Lanes> flux = detail::volume_piola(given.volume, given.stress, given.deformation);
        for (std::size_t n = 0; n < 9; ++n) flux.m[n].store(staged.stress_volume[n] + at);
    } else {
        const core::Sym<Lanes> flux = detail::volume_stress(given.volume, given.stress, averaged, mean_pressure);
        for (std::size_t n = 0; n < 6; ++n) flux.s[n].store(staged.stress_volume[n] + at);
    }
}

namespace detail
{
template <Transfer T, int N, std::size_t Capacity>
[[gnu::always_inline]] inline CornerWeights<N>
add_motion(const CellFrame& frame, const Corners<N>& corners, const Staged<Capacity>& staged, int i,
           const particles::Particles& particles, std::size_t p, CellSum<N>& sum)
{
    const CornerWeights<N> weights = corner_weights(corners, staged.xi[i], staged.eta[i], staged.zeta[i]);
    add_momentum(weights, staged.momentum[0][i], staged.momentum[1][i], staged.momentum[2][i], sum);
    if constexpr (T == Transfer::apic) {
        const Real per_slope = staged.mass[i] / frame.per_spacing;
        add_affine(
            corners, weights, staged.xi[i], staged.eta[i], staged.zeta[i],
            [&](int a, int b) { return per_slope * particles.affine[static_cast<std::size_t>(3 * a + b)][p]; }, sum);
    }
    return weights;
}
} // namespace detail

/// Add the first `count` staged particles, `begin` the first of them, to the nodes: mass, momentum and force, or
/// momentum alone.
template <Formulation F, Transfer T, bool All, bool Momentum = false, std::size_t Capacity>
[[gnu::always_inline]] inline void add_staged(const CellFrame& frame, const Staged<Capacity>& staged, int count,
                                              const particles::Particles& particles, std::size_t begin,
                                              grid::NodeSum* tile)
{
    for (int first = 0; first < 8; first += node_lanes) {
        const Corners<node_lanes> corners = corners_from<node_lanes>(first);
        CellSum<node_lanes> sum;
        clear(sum);
        for (int i = 0; i < count; ++i) {
            if (!All && staged.here[i] == 0) continue;
            const CornerWeights<node_lanes> weights =
                detail::add_motion<T>(frame, corners, staged, i, particles, begin + static_cast<std::size_t>(i), sum);
            if constexpr (Momentum) continue;
            sum.mass += NodeLanes(staged.mass[i]) * weights.w;
            add_force(
                weights, [&](int a, int b) { return staged.stress_volume[detail::flux_place<F>(a, b)][i]; }, sum);
        }
        write_sums<Momentum>(sum, first, frame.per_spacing, tile + frame.node);
    }
}

/// Add the volume and pressure of a chunk to the cell's.
/// @param counts  lanes that take part in the average
[[gnu::always_inline]] inline void add_pressure(const Given& given, LaneMask counts, CellPressure& pressure)
{
    const Lanes mean = core::trace(given.stress) * Lanes(Real(1) / 3);
    pressure.volume += core::sum(core::select(counts, given.volume, Lanes(Real(0))));
    pressure.pressure_volume += core::sum(core::select(counts, given.volume * mean, Lanes(Real(0))));
}

/// Lanes that take the cell's mean pressure, if they are served.
[[gnu::always_inline]] inline LaneMask pressure_lanes(const LawTable& laws, const particles::Particles& particles,
                                                      std::size_t begin, int count)
{
    return intact(particles, begin, count) & law_lanes(laws, particles, begin, count).averaged;
}

/// Mean pressure of the particles [begin, end) that are served and take part in the average.
inline CellPressure pressure_of(Visitors visitors, const LawTable& laws, const particles::Particles& particles,
                                std::size_t begin, std::size_t end)
{
    CellPressure pressure;
    for (std::size_t p = begin; p < end; p += Lanes::lanes) {
        const int count = static_cast<int>(std::min<std::size_t>(Lanes::lanes, end - p));
        add_pressure(read_given<Formulation::updated>(particles, p, count),
                     present<Formulation::updated>(visitors, particles, p, count) &
                         pressure_lanes(laws, particles, p, count),
                     pressure);
    }
    return pressure;
}

/// Scatter the particles [begin, end) that are served.
template <Formulation F, Transfer T>
[[gnu::noinline]] void scatter_cell(const CellFrame& frame, Visitors visitors, const LawTable& laws,
                                    const particles::Particles& particles, std::size_t begin, std::size_t end,
                                    grid::NodeSum* tile)
{
    Staged<group_size<false>> staged;
    for (std::size_t first = begin; first < end; first += group_size<false>) {
        const std::size_t last = std::min(end, first + group_size<false>);
        CellPressure pressure;
        if constexpr (F == Formulation::updated) pressure = pressure_of(visitors, laws, particles, first, last);
        for (std::size_t p = first; p < last; p += Lanes::lanes) {
            const int count = static_cast<int>(std::min<std::size_t>(Lanes::lanes, last - p));
            const int at = static_cast<int>(p - first);
            Given given = read_given<F>(particles, p, count);
            if (laws.any_decohesion && !particles.cracks.empty())
                detail::reduce_to_solid(particles, p, count, given.volume);
            LaneMask averaged{};
            if constexpr (F == Formulation::updated) averaged = pressure_lanes(laws, particles, p, count);
            stage<F>(frame, given, averaged, pressure.mean(), at, staged);
            const LaneMask here = present<F>(visitors, particles, p, count);
            for (int i = 0; i < count; ++i) staged.here[at + i] = here[i] ? 1 : 0;
        }
        add_staged<F, T, F == Formulation::total>(frame, staged, static_cast<int>(last - first), particles, first,
                                                  tile);
    }
}
} // namespace transfer
