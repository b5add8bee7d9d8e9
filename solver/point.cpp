#include "solver/point.h"

#include "material/acoustic.h"
#include "material/decohesion.h"
#include "material/rotation.h"

namespace solver
{
namespace
{
/// Velocity gradient [1/ms] of a step: rate of deformation plus spin. It chooses between conjugate planes.
core::Mat<Real> velocity_gradient(const PointStep& step)
{
    core::Mat<Real> l = material::gradient_increment(step.strain, step.rotation);
    for (Real& entry : l.m) entry /= step.dt;
    return l;
}

/// Elastic or plastic step of an intact point, and the onset at its end.
void advance_intact(const PointLaw& law, const PointStep& step, PointState& state)
{
    const core::Mat<Real> rotation = material::incremental_rotation(step.rotation);
    state.stress = material::elastic_trial(core::rotated(rotation, state.stress),
                                           material::at_end_of_step(step.strain, step.rotation), law.lame);
    if (law.plastic) {
        const auto returned = material::radial_return(state.stress, state.eq_plastic_strain, *law.plastic);
        if (returned.eq_plastic_strain > state.eq_plastic_strain)
            state.acoustic_ratio =
                material::bifurcation(law.material.elastic, law.plastic->hardening, returned.stress).ratio;
        state.stress = returned.stress;
        state.eq_plastic_strain = returned.eq_plastic_strain;
        state.plastic_work += returned.work;
    }
    if (!law.separation) return;
    state.crack = material::onset(*law.material.decohesion, law.material.elastic, state.stress, state.stress,
                                  {velocity_gradient(step), {}}, law.spacing, state.time);
    if (state.crack) state.onset_step = state.step;
}

void advance_cracked(const PointLaw& law, const PointStep& step, PointState& state)
{
    const material::DecohesionStep after =
        material::separate(*law.separation, *state.crack,
                           {state.stress, step.strain, step.rotation, state.eq_plastic_strain, step.dt, state.time});
    state.stress = after.stress;
    state.crack = after.crack;
    state.eq_plastic_strain = after.eq_plastic_strain;
    state.plastic_work += after.plastic_work;
    state.decohesion_work += after.decohesion_work;
}
} // namespace

PointLaw point_law(const material::Material& material, Real spacing)
{
    PointLaw law{material, material::lame_constants<Real>(material.elastic), {}, {}, spacing};
    if (material.plastic) law.plastic = material::plastic_constants<Real>(material.elastic, *material.plastic);
    if (material.decohesion) law.separation = material::separation_law(material);
    return law;
}

PointState advance(const PointLaw& law, const PointState& before, const PointStep& step)
{
    PointState after = before;
    ++after.step;
    after.time += step.dt;
    after.strain = before.strain + step.strain;
    after.acoustic_ratio = 1;
    if (before.crack)
        advance_cracked(law, step, after);
    else
        advance_intact(law, step, after);
    return after;
}
} // namespace solver
