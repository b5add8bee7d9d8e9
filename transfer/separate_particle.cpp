#include "transfer/separate_particle.h"

#include "transfer/solid_share.h"

namespace transfer
{
namespace
{
/// A separated particle resists nothing but compression, so its cell may collapse or turn inside out while the faces
/// slide. Its motion then means nothing, and its stiffness would be unstable: other particles shorten the time step
/// (solver/stable_time_step.h), these do not.
bool tangled(const PassOptions& options, const LawTable& laws, const SeparationInput& input, const core::Crack& crack)
{
    if (crack.damage < 1) return false;
    if (!(input.volume_ratio > smallest_volume_ratio)) return true;
    if (input.deformation == nullptr) return false;
    const Real reach = laws.constants[input.material].wave_speed * options.dt * input.per_spacing;
    return step_share(reach, input.volume_ratio * solid_share(crack), *input.deformation) > input.largest_share;
}
} // namespace

SeparationResult separate_particle(const PassOptions& options, const LawTable& laws, const SeparationInput& input,
                                   core::Crack& crack)
{
    if (tangled(options, laws, input, crack)) return {{}, input.step.eq_plastic_strain, 0, 0};
    const Real volume = input.volume * solid_share(crack);
    const material::DecohesionStep step = material::separate(laws.separation[input.material], crack, input.step);
    crack = step.crack;
    return {step.stress, step.eq_plastic_strain, step.plastic_work * volume, step.decohesion_work * volume};
}
} // namespace transfer
