#include "transfer/separate_lanes.h"

#include "material/decohesion.h"
#include "particles/tensors.h"
#include "transfer/cell_squeeze.h"

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
        for (std::size_t n = 0; n < 9; ++n) t.m[n] = lanes.m[n][lane];
    }
    return t;
}

/// Mean stress tensor of the intact particles, weighted by rest volume.
core::Sym<Real> cell_mean(const particles::Particles& particles, std::size_t begin, std::size_t end)
{
    core::Sym<Real> mean{};
    Real volume = 0;
    for (std::size_t p = begin; p < end; ++p) {
        if (particles.crack[p] >= 0) continue;
        mean = mean + particles.rest_volume[p] * particles::stress_of(particles, p);
        volume += particles.rest_volume[p];
    }
    return (1 / volume) * mean;
}

/// A separated particle resists nothing but compression, so its cell may collapse or turn inside out while the faces
/// slide. Its motion then means nothing, and its stiffness would be unstable: other particles shorten the time step
/// (solver/stable_time_step.h), these do not.
bool tangled(const SeparationInput& input, const particles::Particles& particles, std::size_t p, Real volume_ratio)
{
    constexpr Real smallest_ratio = 0.05;
    if (particles.cracks[static_cast<std::size_t>(particles.crack[p])].damage < 1) return false;
    if (!(volume_ratio > smallest_ratio)) return true;
    if (particles.deformation_gradient[0].empty()) return false;
    const Real wave_speed = input.laws.constants[particles.material[p]].wave_speed;
    return wave_speed * cell_squeeze(particles::deformation_of(particles, p)) * input.options.dt * input.per_spacing >
           unstable_step_share;
}

/// Normal of a crack that already runs through the cell; zero if none.
core::Vec<Real> nearest_normal(const particles::Particles& particles, std::size_t begin, std::size_t end)
{
    for (std::size_t p = begin; p < end; ++p)
        if (particles.crack[p] >= 0) return {particles.cracks[static_cast<std::size_t>(particles.crack[p])].normal};
    return {};
}
} // namespace

Real separate_lanes(const SeparationInput& input, particles::Particles& particles, Lanes& plastic_work)
{
    Real decohesion_work = 0;
    for (int i = 0; i < input.count; ++i) {
        const std::size_t p = input.begin + static_cast<std::size_t>(i);
        if (particles.crack[p] < 0 || !input.here[i]) continue;
        core::Crack& crack = particles.cracks[static_cast<std::size_t>(particles.crack[p])];
        const material::StrainStep strain{lane_of<core::Sym<Real>>(input.stress, i),
                                          lane_of<core::Sym<Real>>(input.strain, i),
                                          lane_of<core::Mat<Real>>(input.rotation, i),
                                          input.eq_plastic_strain[i],
                                          input.options.dt,
                                          input.options.time};
        if (tangled(input, particles, p, input.volume[i] / particles.rest_volume[p])) {
            for (particles::Column& component : particles.stress) component[p] = 0;
            particles.eq_plastic_strain[p] = strain.eq_plastic_strain;
            plastic_work.v[i] = 0;
            continue;
        }
        const Real volume = input.volume[i] * solid_share(crack);
        const material::DecohesionStep step =
            material::separate(input.laws.separation[particles.material[p]], crack, strain);
        for (std::size_t n = 0; n < 6; ++n) particles.stress[n][p] = step.stress.s[n];
        particles.eq_plastic_strain[p] = step.eq_plastic_strain;
        crack = step.crack;
        plastic_work.v[i] = step.plastic_work * volume;
        decohesion_work += step.decohesion_work * volume;
    }
    return decohesion_work;
}

void start_cracks(const PassOptions& options, const LawTable& laws, const particles::Particles& particles,
                  std::size_t begin, std::size_t end, Real spacing, const core::Mat<Real>* gradients,
                  std::vector<Onset>& onset)
{
    const Real per_dt = 1 / options.dt;
    for (std::size_t p = begin; p < end; ++p) {
        const material::Material& material = laws.materials[particles.material[p]];
        if (particles.crack[p] >= 0 || !material.decohesion) continue;
        const core::Sym<Real> own = particles::stress_of(particles, p);
        const core::Sym<Real> test = material.decohesion->smoothed_onset ? cell_mean(particles, begin, end) : own;
        material::Bias bias{gradients[p - begin], nearest_normal(particles, begin, end)};
        for (Real& entry : bias.velocity_gradient.m) entry *= per_dt;
        auto crack = material::onset(*material.decohesion, material.elastic, test, own, bias, spacing, options.time);
        if (!crack) continue;
        crack->particle_id = particles.id[p];
        onset.push_back({static_cast<std::uint32_t>(p), *crack});
    }
}
} // namespace transfer
