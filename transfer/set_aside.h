/// Particles of a block that follow the law of separation: taken out of the lanes, advanced, put back.
#pragma once

#include "material/rotation.h"
#include "transfer/block_work.h"
#include "transfer/separate_particle.h"
#include "transfer/slide_batch.h"
#include "transfer/solid_share.h"

#include <array>

namespace transfer
{
/// A particle that follows the law of separation, with what that law gave.
struct SetAside
{
    int lane, slot;
    std::size_t particle;
    SeparationResult result;
    Real share; // 1, metal part of its volume
};

/// Separated particles of a block on their way through slide_batch.
struct Sliders
{
    SlideBatch batch;
    std::array<SetAside*, SlideBatch::size> out;
};

/// Run the batch and hand its results out.
inline void finish(const Context& context, Sliders& sliders)
{
    SlideBatch& batch = sliders.batch;
    if (batch.count == 0) return;
    slide_batch(context.options, context.laws, context.per_spacing, batch);
    for (std::size_t i = 0; i < static_cast<std::size_t>(batch.count); ++i) {
        SetAside& out = *sliders.out[i];
        for (std::size_t n = 0; n < 6; ++n) out.result.stress.s[n] = batch.stress[n][i];
        out.result.eq_plastic_strain = batch.eq_plastic_strain[i];
        out.result.plastic_work = batch.plastic_work[i];
        out.result.decohesion_work = batch.decohesion_work[i];
        out.share = solid_share(*batch.crack[i]);
    }
    batch.count = 0;
}

inline void enlist(const Context& context, const SeparationInput& input, const core::Mat<Real>& gradient,
                   core::Crack& crack, SetAside& out, Sliders& sliders)
{
    SlideBatch& batch = sliders.batch;
    if (batch.count == SlideBatch::size || (batch.count > 0 && batch.material != input.material))
        finish(context, sliders);
    batch.material = input.material;
    const auto i = static_cast<std::size_t>(batch.count++);
    for (std::size_t n = 0; n < 9; ++n) {
        batch.gradient[n][i] = gradient.m[n];
        batch.deformation[n][i] = input.deformation->m[n];
    }
    for (std::size_t n = 0; n < 6; ++n) batch.stress[n][i] = input.step.stress.s[n];
    batch.eq_plastic_strain[i] = input.step.eq_plastic_strain;
    batch.volume[i] = input.volume;
    batch.volume_ratio[i] = input.volume_ratio;
    batch.largest_share[i] = input.largest_share;
    batch.crack[i] = &crack;
    sliders.out[i] = &out;
}

/// Find the part's particles with decohesion state and ask for their cracks: these lie anywhere in the side table, and
/// waiting for one after the other costs more than the law.
template <class T>
int find_cracks(const Context& context, const BlockPart<T>& part, const particles::Particles& particles,
                SetAside* aside)
{
    int count = 0;
    for (int i = 0; i < part.count(); ++i) {
        const auto cell = static_cast<std::size_t>(part.cell(i));
        if (context.lattice.cracked[context.leaf * grid::leaf_cells + cell] == 0) continue;
        for (int s = 0; s < slots; ++s) {
            if (!part.has(i, s)) continue;
            const std::size_t p = part.particle(i, s);
            if (particles.crack[p] < 0) continue;
            aside[count].lane = i;
            aside[count].slot = s;
            aside[count++].particle = p;
            const auto* crack =
                reinterpret_cast<const char*>(&particles.cracks[static_cast<std::size_t>(particles.crack[p])]);
            for (std::size_t byte = 0; byte < sizeof(core::Crack); byte += 64) __builtin_prefetch(crack + byte, 1);
            __builtin_prefetch(&particles.rest_volume[p]);
        }
    }
    return count;
}

/// Call the law of separation for the part's particles with decohesion state, before the others change any stress.
template <class T>
[[gnu::noinline]] int set_cracks_aside(const Context& context, const BlockPart<T>& part, const BlockState<T>& state,
                                       const Work<T>& work, particles::Particles& particles, SetAside* aside)
{
    const int count = find_cracks(context, part, particles, aside);
    Sliders sliders;
    for (int n = 0; n < count; ++n) {
        SetAside& out = aside[n];
        const int i = out.lane, s = out.slot;
        const std::size_t p = out.particle;
        const auto gradient = lane_of(work.gradient[s], i);
        const auto f = deformation_of_lane(work.displacement, s, i, context.per_spacing);
        const Real volume = static_cast<Real>(work.volume[s][i]);
        core::Crack& crack = particles.cracks[static_cast<std::size_t>(particles.crack[p])];
        SeparationInput input{{stress_at(state, part.lane(i), s),
                               {},
                               {},
                               static_cast<Real>(state.eq_plastic_strain[static_cast<std::size_t>(s)][part.lane(i)]),
                               context.options.dt,
                               context.options.time},
                              volume,
                              volume / particles.rest_volume[p],
                              &f,
                              particles.material[p],
                              context.per_spacing,
                              part.full(i) ? unstable_step_share : deformed_step_share};
        if (crack.damage >= 1) {
            enlist(context, input, gradient, crack, out, sliders);
            continue;
        }
        input.step.strain = core::symmetric_part(gradient);
        input.step.spin = material::spin_increment(gradient);
        out.result = separate_particle(context.options, context.laws, input, crack);
        out.share = solid_share(crack);
    }
    finish(context, sliders);
    return count;
}
} // namespace transfer
