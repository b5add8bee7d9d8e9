/// Grid to particles for one cell (G2P) and the material update, in two stages because the dilatation is averaged over
/// the cell in between.
#pragma once

#include "material/elastic.h"
#include "material/onset.h"
#include "material/rotation.h"
#include "material/von_mises.h"
#include "particles/tensors.h"
#include "transfer/flip.h"
#include "transfer/given.h"
#include "transfer/middle_gradient.h"
#include "transfer/passes.h"
#include "transfer/separate_lanes.h"

#include <algorithm>

namespace transfer
{
/// What a leaf's task collects besides the columns it writes.
struct LeafOutcome
{
    LeafWork work;                     // mJ, of this step
    std::vector<std::uint32_t> leaver; // particles that have left their home cell in this step
    std::vector<Onset> onset;          // particles that begin to separate
};

namespace detail
{
struct Kinematics
{
    core::Mat<Lanes> gradient_increment; // 1, L dt
    Lanes volume;                        // mm^3, middle of the step
    Lanes dilatation;                    // 1, tr(L dt)
    LaneMask here;                       // lanes that are particles of this cell
    LaneMask averaged;                   // those whose dilatation is averaged
    LaneMask may_start;                  // after update_stress: near enough a strength for the exact test
};

[[gnu::always_inline]] inline void store_where(LaneMask keep, Lanes fresh, Lanes old, particles::Column& column,
                                               std::size_t begin, int count)
{
    store(core::select(keep, fresh, old), column, begin, count);
}

/// Velocity gradient of the field in `column`, rows: component, columns: direction.
[[gnu::always_inline]] inline core::Mat<Lanes> gradient(const CellField& field, int column,
                                                        const LocalPosition<Lanes>& at, Lanes per_spacing,
                                                        core::Vec<Lanes>& velocity)
{
    core::Mat<Lanes> g;
    for (int a = 0; a < 3; ++a) {
        velocity[a] = value_and_slopes(field, column + a, at, g(a, 0), g(a, 1), g(a, 2));
        for (int b = 0; b < 3; ++b) g(a, b) *= per_spacing;
    }
    return g;
}

/// F <- F + dt dF, and the increment L dt = dt dF F^{-1} at the middle of the step; `volume` becomes V0 J there.
[[gnu::always_inline]] inline core::Mat<Lanes> advance_deformation(const core::Mat<Lanes>& rate_increment,
                                                                   std::size_t begin, int count,
                                                                   particles::Particles& particles, Lanes& volume,
                                                                   Given& given)
{
    const auto f = load_all<core::Mat<Lanes>>(particles.deformation_gradient, begin, count);
    core::Mat<Lanes> middle;
    for (std::size_t n = 0; n < 9; ++n) {
        middle.m[n] = f.m[n] + Lanes(Real(0.5)) * rate_increment.m[n];
        given.deformation.m[n] = f.m[n] + rate_increment.m[n];
        store(given.deformation.m[n], particles.deformation_gradient[n], begin, count);
    }
    Lanes jacobian;
    const core::Mat<Lanes> l = middle_gradient(rate_increment, middle, jacobian);
    volume *= jacobian;
    return l;
}

[[gnu::noinline]] inline void note_leavers(LaneMask left, std::size_t begin, int count, particles::Particles& particles,
                                           LeafOutcome& outcome)
{
    for (int i = 0; i < count; ++i) {
        if (!left[i]) continue;
        const std::size_t p = begin + static_cast<std::size_t>(i);
        particles.away[p] = 1;
        outcome.leaver.push_back(static_cast<std::uint32_t>(p));
    }
}

/// Second half of stage one: what follows from what the particles read off the grid.
/// @param g       gradient that strains the particles [1/ms], rows: component, columns: direction
/// @param affine  new matrices of APIC [1/ms]; read with stress last only
/// @param change  `change(a)`: change of velocity component a [mm/ms]; called for FLIP with stress last only
/// @param given   gets what the particles give the grid next, but for the stress and, in the total formulation, the
///                position of the weights; a caller that does not read it pays nothing
template <Formulation F, Transfer T, StressUpdate S, bool Plain = false, class Change>
[[gnu::always_inline]] inline void
carry(const PassOptions& options, const LawTable& laws, const CellFrame& frame, Visitors visitors,
      const core::Vec<Lanes>& x, const core::Vec<Lanes>& grid_velocity, core::Mat<Lanes>& g,
      const core::Mat<Lanes>& affine, const Change& change, std::size_t begin, int count,
      particles::Particles& particles, LeafOutcome& outcome, Kinematics& k, Given& given)
{
    const Lanes dt(options.dt);
    if constexpr (S == StressUpdate::usl) {
        for (int a = 0; a < 3; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            const Lanes old = load(particles.velocity[axis], begin, count);
            Lanes fresh = grid_velocity[a];
            if constexpr (T == Transfer::flip)
                fresh = flip_velocity(options.pic_fraction, old, change(a), grid_velocity[a]);
            given.velocity[a] = core::select(k.here, fresh, old);
            store(given.velocity[a], particles.velocity[axis], begin, count);
        }
        if constexpr (T == Transfer::apic)
            for (std::size_t n = 0; n < 9; ++n)
                store_where(k.here, affine.m[n], load(particles.affine[n], begin, count), particles.affine[n], begin,
                            count);
    } else {
        given.velocity = load_all<core::Vec<Lanes>>(particles.velocity, begin, count);
    }
    core::Vec<Lanes> moved;
    for (int a = 0; a < 3; ++a) {
        moved[a] = core::select(k.here, x[a] + dt * grid_velocity[a], x[a]);
        store(moved[a], particles.position[static_cast<std::size_t>(a)], begin, count);
    }
    k.volume = given.volume = load(particles.rest_volume, begin, count);
    for (Lanes& entry : g.m) entry *= dt;
    k.averaged = k.here & law_lanes<Plain>(laws, particles, begin, count).averaged;
    if constexpr (F == Formulation::total) {
        const Lanes least = Lanes(least_averaged_volume) * k.volume;
        k.gradient_increment = advance_deformation(g, begin, count, particles, k.volume, given);
        k.averaged = k.averaged & !(k.volume < least);
    } else {
        k.gradient_increment = g;
        const Lanes ratio = load(particles.volume_ratio, begin, count);
        const Lanes half = Lanes(Real(0.5)) * (g(0, 0) + g(1, 1) + g(2, 2));
        const Lanes fresh = core::select(k.here, ratio * (Lanes(Real(1)) + half) / (Lanes(Real(1)) - half), ratio);
        store(fresh, particles.volume_ratio, begin, count);
        k.volume *= Lanes(Real(0.5)) * (ratio + fresh);
        given.volume *= fresh;
        given.position = moved;
        LaneMask left = k.here & !inside(frame, moved);
        if (visitors == Visitors::everyone) {
            const LaneMask home = present<F>(Visitors::residents, particles, begin, count);
            left = left & home;
            k.averaged = k.averaged & home;
        }
        if (visitors != Visitors::stray && core::any(left)) note_leavers(left, begin, count, particles, outcome);
    }
    k.dilatation = k.gradient_increment(0, 0) + k.gradient_increment(1, 1) + k.gradient_increment(2, 2);
    if (!Plain && laws.any_decohesion && !particles.cracks.empty())
        k.averaged = k.averaged & intact(particles, begin, count);
}

/// Stage one: move the particles, update velocity and deformation, leave what the material needs in `k`.
template <Formulation F, Transfer T, StressUpdate S, bool Plain>
[[gnu::always_inline]] inline void move(const PassOptions& options, const LawTable& laws, const CellFrame& frame,
                                        Visitors visitors, const CellField& field, std::size_t begin, int count,
                                        particles::Particles& particles, LeafOutcome& outcome, Kinematics& k,
                                        Given& given)
{
    const auto x = load_all<core::Vec<Lanes>>(particles.position, begin, count);
    given.mass = load(particles.mass, begin, count);
    LocalPosition<Lanes> at;
    k.here = present<F, Plain>(visitors, particles, begin, count);
    if constexpr (F == Formulation::total) {
        given.position = load_all<core::Vec<Lanes>>(particles.rest_position, begin, count);
        at = local_position(frame, given.position);
    } else {
        at = local_position(frame, x);
    }
    const Lanes per_spacing(frame.per_spacing);
    core::Vec<Lanes> grid_velocity;
    core::Mat<Lanes> g = gradient(field, velocity_column, at, per_spacing, grid_velocity);
    if constexpr (S == StressUpdate::musl) {
        core::Vec<Lanes> remapped;
        g = gradient(field, change_column, at, per_spacing, remapped);
    }
    const auto change = [&](int a) __attribute__((always_inline))
    {
        return value(field, change_column + a, at);
    };
    carry<F, T, S, Plain>(options, laws, frame, visitors, x, grid_velocity, g, g, change, begin, count, particles,
                          outcome, k, given);
}

/// Strain increment with the cell's mean dilatation on averaged lanes.
[[gnu::always_inline]] inline core::Sym<Lanes> strain_increment(const Kinematics& k, Real mean_dilatation)
{
    core::Sym<Lanes> e = core::symmetric_part(k.gradient_increment);
    const Lanes shift =
        core::select(k.averaged, (Lanes(mean_dilatation) - k.dilatation) * Lanes(Real(1) / 3), Lanes(Real(0)));
    for (int a = 0; a < 3; ++a) e[a] += shift;
    return e;
}

/// Stage two: stress, plastic strain, decohesion; the stress that the plastic law gives is returned.
template <bool Plain>
[[gnu::always_inline]] inline core::Sym<Lanes>
update_stress(const PassOptions& options, const LawTable& laws, Real per_spacing, Kinematics& k, Real mean_dilatation,
              std::size_t begin, int count, particles::Particles& particles, LeafOutcome& outcome)
{
    const auto old = load_all<core::Sym<Lanes>>(particles.stress, begin, count);
    const Lanes old_strain = load(particles.eq_plastic_strain, begin, count);
    const LawLanes law = law_lanes<Plain>(laws, particles, begin, count);
    const core::Sym<Lanes> strain = strain_increment(k, mean_dilatation);
    const core::Vec<Lanes> spin = material::spin_increment(k.gradient_increment);
    const core::Sym<Lanes> trial = material::elastic_trial(
        core::rotated(material::incremental_rotation(spin), old), material::at_end_of_step(strain, spin),
        material::LameConstants<Lanes>{law.lame, law.shear + law.shear});
    const material::PlasticStep<Lanes> step = material::radial_return(
        trial, old_strain,
        material::PlasticConstants<Lanes>{law.yield, law.hardening, Lanes(Real(3)) * law.shear, law.per_overstress});
    Lanes plastic_work = core::select(k.here, step.work * k.volume, Lanes(Real(0)));

    core::Sym<Lanes> stress;
    for (std::size_t n = 0; n < 6; ++n) {
        stress.s[n] = core::select(k.here, step.stress.s[n], old.s[n]);
        store(stress.s[n], particles.stress[n], begin, count);
    }
    store_where(k.here, step.eq_plastic_strain, old_strain, particles.eq_plastic_strain, begin, count);
    if (!laws.any_decohesion) {
        outcome.work.plastic += core::sum(plastic_work);
        return stress;
    }
    if (!Plain && !particles.cracks.empty()) {
        const SeparatingChunk chunk{options, laws, per_spacing, begin,      count,   k.here,
                                    strain,  spin, old,         old_strain, k.volume};
        outcome.work.decohesion += separate_lanes(chunk, particles, plastic_work);
    }
    outcome.work.plastic += core::sum(plastic_work);
    k.may_start = k.here & material::may_start(step.stress, law.tensile_onset, law.shear_onset);
    return stress;
}

/// Gradient increments of the first `count` particles of a group, lane by lane.
inline void unpack_gradients(const Kinematics* k, std::size_t count, core::Mat<Real>* gradient)
{
    for (std::size_t p = 0; p < count; ++p)
        for (std::size_t n = 0; n < 9; ++n)
            gradient[p].m[n] = k[p / Lanes::lanes].gradient_increment.m[n][static_cast<int>(p % Lanes::lanes)];
}

/// Exact onset test of the particles [first, last) of a group, where the cheap one did not clear all of them.
[[gnu::noinline]] inline void test_onset(const PassOptions& options, const LawTable& laws, const CellFrame& frame,
                                         const Kinematics* k, std::size_t first, std::size_t last,
                                         const particles::Particles& particles, std::vector<Onset>& onset)
{
    core::Mat<Real> gradient[group_size<false>];
    core::Sym<Real> stress[group_size<false>];
    bool here[group_size<false>];
    unpack_gradients(k, last - first, gradient);
    for (std::size_t p = first; p < last; ++p) {
        stress[p - first] = particles::stress_of(particles, p);
        here[p - first] = k[(p - first) / Lanes::lanes].here[static_cast<int>((p - first) % Lanes::lanes)];
    }
    start_cracks(options, laws, particles, first, last, Real(1) / frame.per_spacing, stress, gradient, here, onset);
}
} // namespace detail

/// Advance the particles [begin, end) of one cell; `move(first, count, k)` is stage one of a chunk.
/// @tparam Plain  the cell is: one group of whole chunks
template <bool Plain = false, class Move>
[[gnu::always_inline]] inline void
advance_group(const PassOptions& options, const LawTable& laws, const CellFrame& frame, std::size_t begin,
              std::size_t end, particles::Particles& particles, LeafOutcome& outcome, const Move& move)
{
    if constexpr (Plain) end = begin + plain_count(begin, end);
    for (std::size_t first = begin; first < end; first += group_size<Plain>) {
        const std::size_t last = Plain ? end : std::min(end, first + group_size<Plain>);
        detail::Kinematics k[group_size<Plain> / Lanes::lanes];
        Real volume = 0;
        Real dilated = 0;
        std::size_t c = 0;
        for (std::size_t p = first; p < last; p += Lanes::lanes, ++c) {
            const int count = Plain ? Lanes::lanes : static_cast<int>(std::min<std::size_t>(Lanes::lanes, last - p));
            // Two copies: without a tail the compiler drops every test of `count`.
            count == Lanes::lanes ? move(p, Lanes::lanes, k[c]) : move(p, count, k[c]);
            volume += core::sum(core::select(k[c].averaged, k[c].volume, Lanes(Real(0))));
            dilated += core::sum(core::select(k[c].averaged, k[c].volume * k[c].dilatation, Lanes(Real(0))));
        }
        const Real mean_dilatation = volume > 0 ? dilated / volume : Real(0);
        bool near_onset = false;
        c = 0;
        for (std::size_t p = first; p < last; p += Lanes::lanes, ++c) {
            const int count = Plain ? Lanes::lanes : static_cast<int>(std::min<std::size_t>(Lanes::lanes, last - p));
            count == Lanes::lanes ? detail::update_stress<Plain>(options, laws, frame.per_spacing, k[c],
                                                                 mean_dilatation, p, Lanes::lanes, particles, outcome)
                                  : detail::update_stress<false>(options, laws, frame.per_spacing, k[c],
                                                                 mean_dilatation, p, count, particles, outcome);
            near_onset = near_onset || (laws.any_decohesion && core::any(k[c].may_start));
        }
        if (near_onset) detail::test_onset(options, laws, frame, k, first, last, particles, outcome.onset);
    }
}

/// Advance the particles [begin, end) that are served.
template <Formulation F, Transfer T, StressUpdate S>
[[gnu::noinline]] void advance_cell(const PassOptions& options, const LawTable& laws, const CellFrame& frame,
                                    Visitors visitors, const grid::NodeMotion* tile, std::size_t begin, std::size_t end,
                                    particles::Particles& particles, LeafOutcome& outcome)
{
    CellField field;
    read_cell(tile + frame.node, field);
    advance_group(
        options, laws, frame, begin, end, particles,
        outcome, [&](std::size_t p, int count, detail::Kinematics& k) __attribute__((always_inline)) {
            Given given; // the scatter reads the columns
            detail::move<F, T, S, false>(options, laws, frame, visitors, field, p, count, particles, outcome, k, given);
        });
}
} // namespace transfer
