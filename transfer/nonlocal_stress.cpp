#include "transfer/nonlocal_stress.h"

#include "material/decohesion.h"
#include "material/lode_memory.h"
#include "transfer/nonlocal_cracks.h"

#include <algorithm>

namespace transfer
{
namespace
{
Real excess_of(const material::Decohesion& law, const core::Sym<Real>& stress)
{
    if (!material::may_start(law, stress)) return 0;
    if (law.weak_plane) return material::onset_ratio(law, material::plane_traction(stress, {*law.weak_plane}));
    const material::Principal principal = material::principal(stress);
    return material::onset_ratio(law, principal, material::lode_parameter(principal));
}

/// Bring L_m of a candidate's cell up to date, on the cell's intact particles.
/// @param lode  1, of the ball's mean stress
/// @return L_m
Real remember(const NonlocalView& view, Real lode, const Candidate& candidate, particles::Particles& particles)
{
    const auto for_each_own = [&](const auto& visit) {
        for (std::uint32_t p = view.levels.cell_start[candidate.slot]; p < view.levels.cell_start[candidate.slot + 1];
             ++p)
            if (particles.crack[p] < 0 && particles.material[p] == candidate.material) visit(p);
    };
    Real strain = 0, mean = 0, last = 0;
    int own = 0, known = 0;
    for_each_own([&](std::uint32_t p) {
        strain += plastic_strain_of(view, particles, p);
        ++own;
        if (particles.lode_strain[p] < 0) return;
        mean += particles.lode_mean[p];
        last += particles.lode_strain[p];
        ++known;
    });
    strain /= own;
    const Real memory = nonlocal_law(view.laws, candidate.material)->lode_memory;
    const Real remembered =
        known == 0 ? lode
                   : material::remembered_lode(mean / known, lode, std::max(strain - last / known, Real(0)), memory);
    for_each_own([&](std::uint32_t p) {
        particles.lode_mean[p] = remembered;
        particles.lode_strain[p] = strain;
    });
    return remembered;
}

core::Sym<Real> ball_mean(const NonlocalView& view, const particles::Particles& particles, const Candidate& candidate)
{
    const auto found = view.table.ball.find(key_of(candidate));
    if (found != view.table.ball.end()) return mean_of(view, particles, found->second);
    return mean_of(view, particles, ball_of(view, particles, candidate));
}
} // namespace

Ball ball_of(const NonlocalView& view, const particles::Particles& particles, const Candidate& candidate)
{
    return ball_about(view.options, view.levels, particles, occupied_cell(view.levels, candidate.slot),
                      candidate.material, nonlocal_law(view.laws, candidate.material)->nonlocal_radius);
}

void choose_tested(const NonlocalView& view, Candidate& candidate, particles::Particles& particles)
{
    const material::Decohesion& law = *nonlocal_law(view.laws, candidate.material);
    candidate.tested = ball_mean(view, particles, candidate);
    if (law.lode_memory > 0 && !law.weak_plane) { // on a given plane no strength depends on it
        const material::Principal principal = material::principal(candidate.tested);
        candidate.lode = remember(view, material::lode_parameter(principal), candidate, particles);
        candidate.excess = material::onset_ratio(law, principal, *candidate.lode);
    } else {
        candidate.excess = excess_of(law, candidate.tested);
    }
    const core::Sym<Real> own =
        mean_of(view, particles, ball_of_cell(view.levels, particles, candidate.slot, candidate.material));
    const Real own_excess = excess_of(law, own);
    candidate.overloaded = own_excess > overload;
    if (own_excess <= std::max(Real(1), candidate.excess)) return;
    const auto test_on = [&](const core::Sym<Real>& stress, Real excess) {
        candidate.tested = stress;
        candidate.lode.reset();
        candidate.excess = excess;
    };
    if (candidate.overloaded) return test_on(own, own_excess);
    const OccupiedCell cell = occupied_cell(view.levels, candidate.slot);
    for (const Vec3& way : arriving_cracks(view, particles, candidate.slot)) {
        const core::Sym<Real> ahead = mean_of(
            view, particles,
            ball_ahead(view.options, view.levels, particles, cell, candidate.material, way, law.nonlocal_radius));
        const Real excess = excess_of(law, ahead);
        if (excess > candidate.excess) test_on(ahead, excess);
    }
}
} // namespace transfer
