#include "material/separation.h"

#include "core/contract.h"
#include "material/crack_faces.h"
#include "material/crack_plane.h"
#include "material/decohesion.h"
#include "material/renewed_plane.h"
#include "material/rotating_crack.h"

#include <algorithm>
#include <cmath>

namespace material
{
namespace
{
constexpr double surface_tolerance = 1e-10; // of U_0 (D.11 item 22)

/// Traction given up by the softening law; advances the damage.
Traction<double> softened(const SeparationLaw& law, core::Crack& crack, const Traction<double>& trial)
{
    const double tension = std::max(trial.normal, 0.0), shear = trial.shear();
    const double x_n = tension / crack.normal_strength, x_t = shear / crack.tangential_strength;
    const double left = strength_left(law.q, crack.damage) + surface_tolerance;
    if (x_n * x_n + x_t * x_t <= left * left) return {};

    const double per_length = crack.surface_energy / crack.effective_length;
    const double b_n = law.wave_modulus * per_length / (crack.normal_strength * crack.normal_strength);
    const double b_t = law.shear_modulus * per_length / (crack.tangential_strength * crack.tangential_strength);
    const double increment = damage_increment(law.q, crack.damage, {x_n, x_t}, {b_n, b_t});
    if (crack.damage + increment >= 1) {
        crack.damage = 1;
        return {tension, trial.tangential};
    }
    crack.damage += increment;
    const double g = strength_left(law.q, crack.damage);
    const double given_n = b_n * increment / (g + b_n * increment), given_t = b_t * increment / (g + b_t * increment);
    return {given_n * tension, given_t * trial.tangential};
}

/// Traction given up by the brittle drop: both components bounded by a ramp that starts at their values at onset.
Traction<double> dropped(const SeparationLaw& law, core::Crack& crack, const Traction<double>& trial, double dt)
{
    crack.damage = std::min(1.0, crack.damage + dt * law.drop_speed / crack.effective_length);
    const double left = 1 - crack.damage;
    const double shear = trial.shear();
    const double excess_n = std::max(0.0, trial.normal - left * crack.drop_traction[0]);
    const double excess_t = std::max(0.0, shear - left * crack.drop_traction[1]);
    return {excess_n, (shear > 0 ? excess_t / shear : 0.0) * trial.tangential};
}

/// Smallest zero of the surface equation for q < 1, where softening starts with an infinite slope: first sign change on
/// a fixed partition, then bisection to rounding.
template <class Excess>
double first_root(const Excess& excess, double end)
{
    constexpr int parts = 64;
    double low = 0;
    for (int part = 1; part <= parts; ++part) {
        double high = end * part / parts;
        if (excess(high) >= 0) {
            low = high;
            continue;
        }
        for (int i = 0; i < 48; ++i) {
            const double middle = 0.5 * (low + high);
            (excess(middle) >= 0 ? low : high) = middle;
        }
        return high;
    }
    return end;
}
} // namespace

double damage_increment(double q, double damage, const std::array<double, 2>& loading,
                        const std::array<double, 2>& stiffness)
{
    const double rest = 1 - damage;
    const double x_n2 = loading[0] * loading[0], x_t2 = loading[1] * loading[1];
    if (q < 1)
        return first_root(
            [&](double d) {
                const double g = strength_left(q, damage + d);
                const double d_n = g + stiffness[0] * d, d_t = g + stiffness[1] * d;
                return x_n2 / (d_n * d_n) + x_t2 / (d_t * d_t) - 1;
            },
            rest);

    // h = S^{-1/2} - 1, S the sum above, is concave for q >= 1 (a CES mean of concave functions): Newton from the left
    // climbs monotonically to the smallest root, one iteration where one component acts and q = 1. A slope that is not
    // positive, or an iterate beyond full separation, proves that there is no root.
    double increment = 0;
    for (int i = 0; i < 50; ++i) {
        const double slope_g = q == 1 ? -1 : -q * std::pow(damage + increment, q - 1);
        const double g = strength_left(q, damage + increment);
        const double d_n = g + stiffness[0] * increment, d_t = g + stiffness[1] * increment;
        const double r_n = x_n2 / (d_n * d_n), r_t = x_t2 / (d_t * d_t);
        const double sum = r_n + r_t, root = std::sqrt(sum);
        if (root <= 1 + 1e-13) return increment;
        const double slope = r_n * (slope_g + stiffness[0]) / d_n + r_t * (slope_g + stiffness[1]) / d_t;
        if (slope <= 0) return rest;
        increment += sum * (root - 1) / slope;
        if (increment >= rest) return rest;
    }
    return rest; // a double root: the next step would lose it anyway
}

SeparationLaw separation_law(const Material& material)
{
    CLEAVE_EXPECTS(material.decohesion.has_value());
    const Decohesion& decohesion = *material.decohesion;
    SeparationLaw law;
    law.lame = lame_constants<double>(material.elastic);
    law.wave_modulus = material.elastic.wave_modulus();
    law.shear_modulus = material.elastic.shear_modulus();
    if (material.plastic) law.plastic = plastic_constants<double>(material.elastic, *material.plastic);
    law.q = decohesion.q;
    if (decohesion.snap_back == SnapBack::brittle_drop)
        law.drop_speed = material.elastic.wave_speed() / decohesion.drop_transits;
    law.rotating_until = decohesion.rotating_until;
    law.friction = decohesion.friction;
    law.renewed_plane = decohesion.renewed_plane;
    law.second_crack = decohesion.second_crack;
    law.second_tension = decohesion.s_max;
    law.second_shear = decohesion.tau_max;
    law.axial_rise = axial_rise(decohesion);
    return law;
}

DecohesionStep separate(const SeparationLaw& law, const core::Crack& crack, const StrainStep& step)
{
    CLEAVE_EXPECTS(crack.effective_length > 0);
    Faces<double> faces{{crack.normal},
                        {crack.slip},
                        crack.opening,
                        crack.effective_length,
                        step.stress,
                        step.eq_plastic_strain,
                        0,
                        0,
                        crack.second_time >= 0 ? 1.0 : 0.0};
    const Traction<double> before = begin_step(law, step.spin, step.strain, faces);
    core::Crack after = crack;
    if (crack.damage >= 1) {
        slide(law, before, faces);
        if (crack.second_time < 0 && faces.crossed > 0) after.second_time = step.time;
    } else {
        const double turned = crack.damage < law.rotating_until && crack.mode == static_cast<int>(Mode::opening)
                                  ? rotate_to_strain(law, faces)
                                  : 0;
        after.effective_length = faces.effective_length; // the softening law reads it
        const Traction<double> trial = traction_on(faces.stress, faces.normal);
        const bool brittle = law.drop_speed > 0 && crack.snap_back_ratio >= 1;
        const Traction<double> released = brittle ? dropped(law, after, trial, step.dt) : softened(law, after, trial);
        open(law, before, trial, released, faces);
        faces.decohesion_work += turned;
        if (law.renewed_plane && after.damage < 1) renew_plane(after, step, faces);
        if (after.damage >= 1) after.separation_time = step.time;
    }
    after.snap_back_ratio *= faces.effective_length / crack.effective_length; // L_crit stays that of the onset
    after.effective_length = faces.effective_length;
    after.normal = faces.normal.v;
    after.slip = faces.slip.v;
    after.opening = faces.opening;
    return {faces.stress, after, faces.eq_plastic_strain, faces.decohesion_work, faces.plastic_work};
}
} // namespace material
