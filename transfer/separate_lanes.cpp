#include "transfer/separate_lanes.h"

#include "material/decohesion.h"
#include "particles/tensors.h"
#include "transfer/separate_particle.h"

namespace transfer
{
namespace
{
template <class Tensor, class LaneTensor>
Tensor lane_of(const LaneTensor& lanes, int lane)
{
    Tensor t{};
    if constexpr (requires { t.s; }) {
        for (std::size_t n = 0; n < 6; ++n) t.s[n] = lanes.s[n][lane];
    } else {
        for (std::size_t n = 0; n < 3; ++n) t.v[n] = lanes.v[n][lane];
    }
    return t;
}

/// Mean stress tensor of the intact particles of a material, weighted by rest volume.
core::Sym<Real> cell_mean(const particles::Particles& particles, std::size_t begin, std::size_t end,
                          std::uint8_t material, const core::Sym<Real>* stresses, const bool* here)
{
    core::Sym<Real> mean{};
    Real volume = 0;
    for (std::size_t p = begin; p < end; ++p) {
        if (particles.crack[p] >= 0 || particles.material[p] != material || !here[p - begin]) continue;
        mean = mean + particles.rest_volume[p] * stresses[p - begin];
        volume += particles.rest_volume[p];
    }
    return volume > 0 ? (1 / volume) * mean : mean;
}

/// Normal of a crack that already runs through the cell; zero if none.
core::Vec<Real> nearest_normal(const particles::Particles& particles, std::size_t begin, std::size_t end,
                               const bool* here)
{
    for (std::size_t p = begin; p < end; ++p)
        if (particles.crack[p] >= 0 && here[p - begin])
            return {particles.cracks[static_cast<std::size_t>(particles.crack[p])].normal};
    return {};
}
} // namespace

Real separate_lanes(const SeparatingChunk& chunk, particles::Particles& particles, Lanes& plastic_work)
{
    Real decohesion_work = 0;
    const bool total = !particles.deformation_gradient[0].empty();
    for (int i = 0; i < chunk.count; ++i) {
        const std::size_t p = chunk.begin + static_cast<std::size_t>(i);
        if (particles.crack[p] < 0 || !chunk.here[i]) continue;
        core::Mat<Real> deformation;
        if (total) deformation = particles::deformation_of(particles, p);
        const SeparationInput input{{lane_of<core::Sym<Real>>(chunk.stress, i),
                                     lane_of<core::Sym<Real>>(chunk.strain, i), lane_of<core::Vec<Real>>(chunk.spin, i),
                                     chunk.eq_plastic_strain[i], chunk.options.dt, chunk.options.time},
                                    chunk.volume[i],
                                    chunk.volume[i] / particles.rest_volume[p],
                                    total ? &deformation : nullptr,
                                    particles.material[p],
                                    chunk.per_spacing};
        const SeparationResult result = separate_particle(
            chunk.options, chunk.laws, input, particles.cracks[static_cast<std::size_t>(particles.crack[p])]);
        for (std::size_t n = 0; n < 6; ++n) particles.stress[n][p] = result.stress.s[n];
        particles.eq_plastic_strain[p] = result.eq_plastic_strain;
        plastic_work.v[i] = result.plastic_work;
        decohesion_work += result.decohesion_work;
    }
    return decohesion_work;
}

void start_cracks(const PassOptions& options, const LawTable& laws, const particles::Particles& particles,
                  std::size_t begin, std::size_t end, Real spacing, const core::Sym<Real>* stresses,
                  const core::Mat<Real>* gradients, const bool* here, std::vector<Onset>& onset)
{
    const Real per_dt = 1 / options.dt;
    for (std::size_t p = begin; p < end; ++p) {
        const material::Material& material = laws.materials[particles.material[p]];
        if (particles.crack[p] >= 0 || !material.decohesion || material.decohesion->nonlocal_radius > 0) continue;
        if (!here[p - begin]) continue;
        const core::Sym<Real>& own = stresses[p - begin];
        const core::Sym<Real> test = material.decohesion->smoothed_onset
                                         ? cell_mean(particles, begin, end, particles.material[p], stresses, here)
                                         : own;
        // The lanes were flagged for their own stresses, and one flags the whole cell.
        if (!material::may_start(*material.decohesion, test)) continue;
        material::Bias bias{gradients[p - begin], nearest_normal(particles, begin, end, here)};
        for (Real& entry : bias.velocity_gradient.m) entry *= per_dt;
        auto crack = material::onset(*material.decohesion, material.elastic, test, own, bias, spacing, options.time);
        if (!crack) continue;
        crack->particle_id = particles.id[p];
        onset.push_back({static_cast<std::uint32_t>(p), *crack});
    }
}
} // namespace transfer
