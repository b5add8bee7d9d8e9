/// Particles of one cell to its nodes: mass, momentum and internal force.
#pragma once

#include "transfer/cell_sum.h"
#include "transfer/chunk.h"
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

namespace detail
{
/// The quantities the node lanes broadcast, one array entry per particle of the chunk.
struct Staged
{
    static constexpr int lanes = Lanes::lanes;
    alignas(64) Real xi[lanes], eta[lanes], zeta[lanes], mass[lanes];
    alignas(64) Real momentum[3][lanes];
    alignas(64) Real stress_volume[9][lanes];
    LaneMask here;
};

inline void store_matrix(const core::Mat<Lanes>& m, Real (*to)[Staged::lanes])
{
    for (std::size_t n = 0; n < 9; ++n) m.m[n].store(to[n]);
}

/// V sigma, with the pressure replaced by the cell mean on `averaged` lanes.
[[gnu::always_inline]] inline core::Mat<Lanes> volume_stress(Lanes volume, const core::Sym<Lanes>& stress,
                                                             LaneMask averaged, Real mean_pressure)
{
    const Lanes mean = core::trace(stress) * Lanes(Real(1) / 3);
    const Lanes shift = core::select(averaged, Lanes(mean_pressure) - mean, Lanes(Real(0)));
    core::Mat<Lanes> m;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) m(i, j) = volume * (i == j ? stress(i, j) + shift : stress(i, j));
    return m;
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

template <Formulation F, bool Plain>
[[gnu::always_inline]] inline void stage(const CellFrame& frame, Visitors visitors, const LawTable& laws,
                                         const CellPressure& pressure, const particles::Particles& particles,
                                         std::size_t begin, int count, Staged& staged)
{
    const auto x = load_all<core::Vec<Lanes>>(weight_position<F>(particles), begin, count);
    const LocalPosition<Lanes> at = local_position(frame, x);
    at.xi.store(staged.xi);
    at.eta.store(staged.eta);
    at.zeta.store(staged.zeta);
    const Lanes mass = load(particles.mass, begin, count);
    mass.store(staged.mass);
    for (std::size_t a = 0; a < 3; ++a) (mass * load(particles.velocity[a], begin, count)).store(staged.momentum[a]);
    const auto stress = load_all<core::Sym<Lanes>>(particles.stress, begin, count);
    Lanes volume = load(particles.rest_volume, begin, count);
    if (!Plain && laws.any_decohesion && !particles.cracks.empty()) reduce_to_solid(particles, begin, count, volume);
    if constexpr (F == Formulation::total) {
        const auto f = load_all<core::Mat<Lanes>>(particles.deformation_gradient, begin, count);
        store_matrix(volume_piola(volume, stress, f), staged.stress_volume);
    } else {
        const LawLanes law = law_lanes<Plain>(laws, particles, begin, count);
        const LaneMask averaged = law.averaged & intact<Plain>(particles, begin, count);
        volume *= load(particles.volume_ratio, begin, count);
        store_matrix(volume_stress(volume, stress, averaged, pressure.mean()), staged.stress_volume);
    }
    staged.here = present<F, Plain>(visitors, particles, begin, count);
}

template <Transfer T>
[[gnu::always_inline]] inline void add_particle(const CellFrame& frame, const Staged& staged, int i,
                                                const particles::Particles& particles, std::size_t p, CellSum& sum)
{
    const CornerWeights weights = corner_weights(staged.xi[i], staged.eta[i], staged.zeta[i]);
    sum.mass += NodeLanes(staged.mass[i]) * weights.w;
    add_momentum(weights, staged.momentum[0][i], staged.momentum[1][i], staged.momentum[2][i], sum);
    if constexpr (T == Transfer::apic) {
        const Real per_slope = staged.mass[i] / frame.per_spacing;
        add_affine(
            weights, staged.xi[i], staged.eta[i], staged.zeta[i],
            [&](int a, int b) { return per_slope * particles.affine[static_cast<std::size_t>(3 * a + b)][p]; }, sum);
    }
    add_force(
        weights, [&](int a, int b) { return staged.stress_volume[3 * a + b][i]; }, sum);
}
} // namespace detail

/// Add the volume and pressure of the particles [begin, end) that are served and take part in the average.
template <bool Plain = false>
inline void add_pressure(Visitors visitors, const LawTable& laws, const particles::Particles& particles,
                         std::size_t begin, std::size_t end, CellPressure& pressure)
{
    for (std::size_t p = begin; p < end; p += Lanes::lanes) {
        const int count = static_cast<int>(std::min<std::size_t>(Lanes::lanes, end - p));
        const LaneMask counts = present<Formulation::updated, Plain>(visitors, particles, p, count) &
                                intact<Plain>(particles, p, count) &
                                law_lanes<Plain>(laws, particles, p, count).averaged;
        const Lanes volume = load(particles.rest_volume, p, count) * load(particles.volume_ratio, p, count);
        const Lanes mean = (load(particles.stress[0], p, count) + load(particles.stress[1], p, count) +
                            load(particles.stress[2], p, count)) *
                           Lanes(Real(1) / 3);
        pressure.volume += core::sum(core::select(counts, volume, Lanes(Real(0))));
        pressure.pressure_volume += core::sum(core::select(counts, volume * mean, Lanes(Real(0))));
    }
}

namespace detail
{
template <Formulation F, Transfer T, bool Plain>
[[gnu::noinline]] void scatter_served(const CellFrame& frame, Visitors visitors, const LawTable& laws,
                                      const particles::Particles& particles, std::size_t begin, std::size_t end,
                                      grid::NodeSum* tile)
{
    CellPressure pressure;
    if constexpr (F == Formulation::updated) add_pressure<Plain>(visitors, laws, particles, begin, end, pressure);
    CellSum sum;
    clear(sum);
    for (std::size_t p = begin; p < end; p += Lanes::lanes) {
        const int count = Plain ? Lanes::lanes : static_cast<int>(std::min<std::size_t>(Lanes::lanes, end - p));
        Staged staged;
        // Two copies: without a tail the compiler drops every test of `count`.
        Plain || count == Lanes::lanes
            ? stage<F, Plain>(frame, visitors, laws, pressure, particles, p, Lanes::lanes, staged)
            : stage<F, Plain>(frame, visitors, laws, pressure, particles, p, count, staged);
        for (int i = 0; i < count; ++i)
            if (Plain || F == Formulation::total || staged.here[i])
                add_particle<T>(frame, staged, i, particles, p + static_cast<std::size_t>(i), sum);
    }
    write_cell(sum, frame.per_spacing, tile + frame.node);
}
} // namespace detail

/// Scatter the particles [begin, end) that are served.
template <Formulation F, Transfer T>
void scatter_cell(const CellFrame& frame, Visitors visitors, const LawTable& laws,
                  const particles::Particles& particles, std::size_t begin, std::size_t end, grid::NodeSum* tile)
{
    visitors == Visitors::residents&& is_plain(particles, begin, end)
        ? detail::scatter_served<F, T, true>(frame, visitors, laws, particles, begin, end, tile)
        : detail::scatter_served<F, T, false>(frame, visitors, laws, particles, begin, end, tile);
}
} // namespace transfer
