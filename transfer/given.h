/// What a chunk of particles gives its nodes, as lanes: read from the columns, or handed on by the kernel that has just
/// computed it.
#pragma once

#include "transfer/chunk.h"

namespace transfer
{
struct Given
{
    core::Vec<Lanes> position;    // mm, where weights are taken
    core::Vec<Lanes> velocity;    // mm/ms
    core::Sym<Lanes> stress;      // MPa
    Lanes mass;                   // g
    Lanes volume;                 // mm^3; total formulation: at rest
    core::Mat<Lanes> deformation; // 1, total formulation only
};

template <Formulation F>
[[gnu::always_inline]] inline Given read_given(const particles::Particles& particles, std::size_t begin, int count)
{
    Given given{load_all<core::Vec<Lanes>>(weight_position<F>(particles), begin, count),
                load_all<core::Vec<Lanes>>(particles.velocity, begin, count),
                load_all<core::Sym<Lanes>>(particles.stress, begin, count),
                load(particles.mass, begin, count),
                load(particles.rest_volume, begin, count),
                {}};
    if constexpr (F == Formulation::total)
        given.deformation = load_all<core::Mat<Lanes>>(particles.deformation_gradient, begin, count);
    else
        given.volume *= load(particles.volume_ratio, begin, count);
    return given;
}
} // namespace transfer
