#include "core/parallel.h"
#include "material/elastic.h"
#include "material/onset.h"
#include "material/rotation.h"
#include "material/von_mises.h"
#include "transfer/lattice.h"
#include "transfer/leaf_columns.h"
#include "transfer/middle_gradient.h"
#include "transfer/separate_lanes.h"
#include "transfer/set_aside.h"

#include <algorithm>

namespace transfer
{
namespace
{
/// Gradients of the part's cells at the slots, and the volumes.
template <class T>
[[gnu::always_inline]] inline void find_gradients(const Context& context, const MotionColumns<T>& motion,
                                                  const BlockPart<T>& part, Work<T>& work)
{
    using V = PartLanes<T>;
    V corner_velocity[3][8], corner_displacement[3][8];
    gather_corners(motion, part, corner_velocity, corner_displacement);
    Slopes<V> velocity[3];
    for (int a = 0; a < 3; ++a) {
        velocity[a] = slopes_at_slots(corner_velocity[a]);
        work.displacement[a] = slopes_at_slots(corner_displacement[a]);
    }
    const V scale(context.options.dt * context.per_spacing);
    for (int s = 0; s < slots; ++s) {
        core::Mat<V> increment;
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) increment(a, b) = scale * velocity[a].along[b][slope_place(b, s)];
        // F in the middle of the step; `displacement` belongs to its end.
        core::Mat<V> middle = deformation_at(work.displacement, s, context.per_spacing);
        for (std::size_t n = 0; n < 9; ++n) middle.m[n] -= V(Real(0.5)) * increment.m[n];
        V jacobian;
        work.gradient[s] = middle_gradient(increment, middle, jacobian);
        work.volume[s] = work.rest_volume[s] * jacobian;
    }
}

template <class T>
using PartMask = core::Mask<T, part_lanes<T>>;

/// 1 where a slot takes the mean dilatation of its cell, else 0.
template <class T>
[[gnu::always_inline]] inline PartLanes<T> averaged(const Work<T>& work, const SlotLaw<T>& law, int s)
{
    using V = PartLanes<T>;
    return core::select(work.volume[s] < V(T(least_averaged_volume)) * work.rest_volume[s], V(T(0)), law.averaged);
}

/// Mean dilatation of the averaged particles of every cell, weighted by volume (methods.md B8).
/// @param intact  [slot] lanes with a particle that follows the plastic law
template <class T>
[[gnu::always_inline]] inline PartLanes<T> mean_dilatation(const Work<T>& work, int law_step,
                                                           const PartMask<T> (&intact)[slots])
{
    using V = PartLanes<T>;
    V volume(T(0)), dilated(T(0));
    for (int s = 0; s < slots; ++s) {
        const core::Mat<V>& g = work.gradient[s];
        const V weight = core::select(intact[s], work.volume[s] * averaged(work, work.law[s * law_step], s), V(T(0)));
        volume += weight;
        dilated += core::select(intact[s], weight * (g(0, 0) + g(1, 1) + g(2, 2)), V(T(0)));
    }
    return core::select(volume > V(T(0)), dilated / volume, V(T(0)));
}

/// Stress and plastic strain of one slot after the step, zero stress where nothing is intact; the plastic work is
/// returned [mJ].
template <class T>
[[gnu::always_inline]] inline PartLanes<T> update_stress(const SlotLaw<T>& law, PartMask<T> intact, PartLanes<T> mean,
                                                         const BlockPart<T>& part, int s, const Work<T>& work,
                                                         BlockState<T>& state, core::Sym<PartLanes<T>>& stress)
{
    using V = PartLanes<T>;
    const core::Mat<V>& g = work.gradient[s];
    core::Sym<V> strain = core::symmetric_part(g);
    const V shift = averaged(work, law, s) * (mean - core::trace(strain)) * V(Real(1) / 3);
    for (int a = 0; a < 3; ++a) strain[a] += shift;
    core::Sym<V> old;
    for (std::size_t n = 0; n < 6; ++n) old.s[n] = part.load(state.stress[n], s);
    const core::Vec<V> spin = material::spin_increment(g);
    const core::Sym<V> trial = material::elastic_trial(core::rotated(material::incremental_rotation(spin), old),
                                                       material::at_end_of_step(strain, spin),
                                                       material::LameConstants<V>{law.lame, law.shear + law.shear});
    const material::PlasticStep<V> step = material::radial_return(
        trial, part.load(state.eq_plastic_strain, s),
        material::PlasticConstants<V>{law.yield, law.hardening, V(Real(3)) * law.shear, law.per_overstress});
    for (std::size_t n = 0; n < 6; ++n) {
        stress.s[n] = core::select(intact, step.stress.s[n], V(T(0)));
        part.store(stress.s[n], s, state.stress[n]);
    }
    part.store(step.eq_plastic_strain, s, state.eq_plastic_strain);
    return core::select(intact, step.work * work.volume[s], V(T(0)));
}

/// V0 P = V0 sigma cof(F) of slot S, put or added to the fluxes of the slopes it shares. (The slot is a constant: with
/// places found while it runs the kernel spent a fifth of its time here.)
template <int S, class T>
[[gnu::always_inline]] inline void add_flux(Real per_spacing, const BlockPart<T>& part, const BlockState<T>& state,
                                            const Work<T>& work, Slopes<PartLanes<T>> (&flux)[3])
{
    using V = PartLanes<T>;
    const core::Mat<V> cof = core::cofactor(deformation_at(work.displacement, S, per_spacing));
    const V volume = work.rest_volume[S] * V(-per_spacing); // f = - sum V0 P grad w
    core::Sym<V> stress;
    for (std::size_t n = 0; n < 6; ++n) stress.s[n] = volume * part.load(state.stress[n], S);
    const auto share = [&]<int J>(std::integral_constant<int, J>) __attribute__((always_inline))
    {
        constexpr int place = slope_place(J, S);
        constexpr bool first = (S & (4 >> J)) == 0; // of the two slots that share it, the lower along J
        for (int i = 0; i < 3; ++i) {
            V& sum = flux[i].along[J][place];
            const V own = stress(i, 0) * cof(0, J) + stress(i, 1) * cof(1, J) + stress(i, 2) * cof(2, J);
            sum = first ? own : sum + own;
        }
    };
    share(std::integral_constant<int, 0>{});
    share(std::integral_constant<int, 1>{});
    share(std::integral_constant<int, 2>{});
}

template <class T>
[[gnu::always_inline]] inline void scatter_force(const Context& context, const BlockPart<T>& part,
                                                 const BlockState<T>& state, const Work<T>& work,
                                                 ForceColumns<T>& columns)
{
    using V = PartLanes<T>;
    Slopes<V> flux[3]; // N mm, V0 P summed over slots that share a slope, [component]
    [&]<int... S>(std::integer_sequence<int, S...>) __attribute__((always_inline))
    {
        (add_flux<S>(context.per_spacing, part, state, work, flux), ...);
    }
    (std::make_integer_sequence<int, slots>{});
    V force[3][8];
    for (int a = 0; a < 3; ++a) slopes_to_corners(flux[a], force[a]);
    scatter_corners(force, part, columns);
}

/// Exact onset test of a cell where the cheap one did not clear every particle.
template <class T>
[[gnu::noinline]] void test_onset(const Context& context, const BlockPart<T>& part, const BlockState<T>& state,
                                  const Work<T>& work, int lane, const particles::Particles& particles,
                                  std::vector<Onset>& onset)
{
    core::Sym<Real> stress[slots];
    core::Mat<Real> gradient[slots];
    bool here[slots]; // nobody leaves a lattice
    std::fill_n(here, slots, true);
    std::size_t count = 0;
    for (int s = 0; s < slots; ++s) {
        if (!part.has(lane, s)) continue;
        stress[count] = stress_at(state, part.lane(lane), s);
        gradient[count++] = lane_of(work.gradient[s], lane);
    }
    const std::size_t begin = part.block.begin[part.lane(lane)];
    start_cracks(context.options, context.laws, particles, begin, begin + count, Real(1) / context.per_spacing, stress,
                 gradient, here, onset);
}

/// Ask for a state ahead of its use: one dense stream outruns what the hardware fetches by itself. Into the second
/// cache: the first one is full with the work on a block, and what comes too early is pushed out before it is read.
template <class T>
[[gnu::always_inline]] inline void prefetch(const BlockState<T>* state)
{
    const char* begin = reinterpret_cast<const char*>(state);
    for (std::size_t byte = 0; byte < sizeof(BlockState<T>); byte += 64) __builtin_prefetch(begin + byte, 0, 2);
}

template <class T>
[[gnu::noinline]] void advance_part(const Context& context, const BlockPart<T>& part, const MotionColumns<T>& motion,
                                    BlockState<T>& state, particles::Particles& particles, ForceColumns<T>& force,
                                    LeafWork& leaf_work, std::vector<Onset>& onset, std::vector<int>& near_cells)
{
    using V = PartLanes<T>;
    Work<T> work;
    for (int s = 0; s < slots; ++s) work.rest_volume[s] = part.load(state.rest_volume, s);
    find_gradients(context, motion, part, work);

    const int law_step = find_laws(context, part, particles, work.law);

    SetAside aside[slots * part_lanes<T>];
    int asides = 0;
    if (!particles.cracks.empty()) asides = set_cracks_aside(context, part, state, work, particles, aside);

    PartMask<T> intact[slots];
    for (int s = 0; s < slots; ++s) intact[s] = work.rest_volume[s] > V(T(0));
    for (int n = 0; n < asides; ++n) intact[aside[n].slot].v[aside[n].lane] = 0;

    const V mean = mean_dilatation(work, law_step, intact);
    V plastic(T(0));
    PartMask<T> near = plastic > plastic;
    for (int s = 0; s < slots; ++s) {
        const SlotLaw<T>& law = work.law[s * law_step];
        core::Sym<V> stress;
        plastic += update_stress(law, intact[s], mean, part, s, work, state, stress);
        if (context.laws.any_decohesion)
            near = near | (intact[s] & material::may_start(stress, law.tensile_onset, law.shear_onset));
    }
    leaf_work.plastic += static_cast<Real>(core::sum(plastic));
    for (int n = 0; n < asides; ++n) {
        const auto& [lane, slot, particle, result, share] = aside[n];
        const std::size_t s = static_cast<std::size_t>(slot), i = part.lane(lane);
        for (std::size_t c = 0; c < 6; ++c) state.stress[c][s][i] = static_cast<T>(result.stress.s[c]);
        state.eq_plastic_strain[s][i] = static_cast<T>(result.eq_plastic_strain);
        work.rest_volume[slot].v[lane] *= static_cast<T>(share);
        leaf_work.plastic += result.plastic_work;
        leaf_work.decohesion += result.decohesion_work;
    }

    scatter_force(context, part, state, work, force);

    if (context.laws.any_decohesion && core::any(near))
        for (int i = 0; i < part.count(); ++i) {
            if (!near[i]) continue;
            test_onset(context, part, state, work, i, particles, onset);
            if (context.laws.nonlocal_radius > 0) near_cells.push_back(part.cell(i));
        }
}

template <class T>
void advance_leaf(const Context& context, BlockTable<T>& table, particles::Particles& particles, grid::Levels& levels,
                  LeafWork& leaf_work, std::vector<Onset>& onset, std::vector<int>& near_cells)
{
    near_cells.clear();
    const grid::NodeBox& used = levels.used[context.leaf];
    const std::uint32_t begin = table.start[context.leaf], end = table.start[context.leaf + 1];
    MotionColumns<T> motion;
    if (begin != end) read_motion(levels.motions(context.leaf), used, table.block[begin].node[0], motion);
    ForceColumns<T> force;
    clear<T>(force);
    for (std::uint32_t b = begin; b < end; ++b) {
        prefetch(&table.state[b] + 1); // beyond the last one nothing is read
        for (int first = 0; first < table.block[b].count; first += part_lanes<T>)
            advance_part(context, BlockPart<T>{table.block[b], first}, motion, table.state[b], particles, force,
                         leaf_work, onset, near_cells);
    }
    write_forces<T>(force, used, levels.forces(context.leaf));
}

/// Give every starting particle its entry in the side table, in leaf order.
void record_onsets(Lattice& lattice, const grid::Levels& levels, particles::Particles& particles)
{
    for (std::size_t n = 0; n < lattice.onset.size(); ++n) {
        if (lattice.onset[n].empty()) continue;
        const std::uint32_t* start = levels.cell_start.data() + n * grid::leaf_cells;
        for (const Onset& onset : lattice.onset[n]) {
            record(onset, particles);
            const auto cell = std::upper_bound(start, start + grid::leaf_cells + 1, onset.particle) - start - 1;
            lattice.cracked[n * grid::leaf_cells + static_cast<std::size_t>(cell)] = 1;
        }
        lattice.onset[n].clear();
    }
}
} // namespace

void advance_lattice(const PassOptions& options, const LawTable& laws, Lattice& lattice,
                     particles::Particles& particles, grid::Levels& levels, std::vector<LeafWork>& leaf_work)
{
    advance_lattice(grid::LevelSteps{options.dt}, options, laws, lattice, particles, levels, leaf_work);
}

void advance_lattice(const grid::LevelSteps& steps, const PassOptions& options, const LawTable& laws, Lattice& lattice,
                     particles::Particles& particles, grid::Levels& levels, std::vector<LeafWork>& leaf_work)
{
    const std::size_t first = levels.first_leaf(steps.first);
    std::visit(
        [&](auto& table) {
            core::parallel_for(levels.leaves.size() - first, [&](std::size_t task) {
                const std::size_t n = first + task;
                const int level = levels.leaves[n].level;
                PassOptions of_level = options;
                of_level.dt = steps.of(level);
                const Context context{of_level, laws, lattice, Real(1) / levels.spacing(level), n};
                advance_leaf(context, table, particles, levels, leaf_work[n], lattice.onset[n], lattice.near[n]);
            });
        },
        lattice.blocks);
    record_onsets(lattice, levels, particles);
}
} // namespace transfer
