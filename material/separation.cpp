#include "material/separation.h"

#include "core/contract.h"

#include <algorithm>
#include <cmath>

namespace material
{
namespace
{
using Vec = core::Vec<double>;
using Sym = core::Sym<double>;

constexpr double surface_tolerance = 1e-10; // of U_0 (D.11 item 22)

/// Traction on the crack plane, split.
struct Traction
{
    double normal = 0; // MPa
    Vec tangential{};  // MPa
    double shear() const { return std::sqrt(core::dot(tangential, tangential)); }
};

Traction traction_on(const Sym& stress, const Vec& normal)
{
    const Vec whole = stress * normal;
    const double along = core::dot(whole, normal);
    return {along, whole - along * normal};
}

/// Stress after the traction gave way by `released`: sigma^tr - [lambda_L du_n I + mu (n du + du n)] / L_e with
/// du_n = L_e released_n / M, du_t = L_e released_t / mu.
Sym relaxed(const SeparationLaw& law, const Sym& trial, const Vec& n, const Traction& released)
{
    const double opening = released.normal / law.wave_modulus;
    const double volumetric = law.lame.lame * opening;
    const Vec a = (law.shear_modulus * opening) * n + released.tangential; // stress part n a^T + a n^T
    return {{trial[0] - volumetric - 2 * n[0] * a[0], trial[1] - volumetric - 2 * n[1] * a[1],
             trial[2] - volumetric - 2 * n[2] * a[2], trial[3] - n[0] * a[1] - n[1] * a[0],
             trial[4] - n[1] * a[2] - n[2] * a[1], trial[5] - n[2] * a[0] - n[0] * a[2]}};
}

/// Add the opening that released the traction to the crack and its trapezoidal work to the step, all at once.
void open(const SeparationLaw& law, const Traction& before, const Traction& trial, const Traction& released,
          const Vec& n, DecohesionStep& result)
{
    core::Crack& crack = result.crack;
    const double strain_n = released.normal / law.wave_modulus; // du_n / L_e
    crack.opening += crack.effective_length * strain_n;
    for (int i = 0; i < 3; ++i)
        crack.slip[static_cast<std::size_t>(i)] += crack.effective_length * released.tangential[i] / law.shear_modulus;

    const Traction after{trial.normal - released.normal, trial.tangential - released.tangential};
    const double work =
        0.5 * ((before.normal + after.normal) * strain_n +
               core::dot(before.tangential + after.tangential, released.tangential) / law.shear_modulus);
    result.decohesion_work += std::max(work, 0.0); // negative: only the trapezoid's error where a traction changes sign
    result.stress = relaxed(law, result.stress, n, released);
}

/// (1 - lambda^q), the part of the strength left.
double strength_left(double q, double damage)
{
    return q == 1 ? 1 - damage : 1 - std::pow(damage, q);
}

/// Traction given up by the softening law; advances the damage.
Traction softened(const SeparationLaw& law, core::Crack& crack, const Traction& trial)
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
Traction dropped(const SeparationLaw& law, core::Crack& crack, const Traction& trial, double dt)
{
    crack.damage = std::min(1.0, crack.damage + dt * law.drop_speed / crack.effective_length);
    const double left = 1 - crack.damage;
    const double shear = trial.shear();
    const double excess_n = std::max(0.0, trial.normal - left * crack.drop_traction[0]);
    const double excess_t = std::max(0.0, shear - left * crack.drop_traction[1]);
    return {excess_n, (shear > 0 ? excess_t / shear : 0.0) * trial.tangential};
}

/// Traction a separated crack cannot carry: all tension; all shear beyond friction. Closing stops at zero opening, so
/// the release is negative (the gap gives way to compression) at most by the opening there is.
Traction unsupported(const SeparationLaw& law, const core::Crack& crack, const Traction& trial)
{
    const double gap = law.wave_modulus * crack.opening / crack.effective_length; // MPa that closing takes up
    const double released_n = std::max(-gap, trial.normal);
    const double shear = trial.shear();
    const double held = std::min(shear, law.friction * std::max(0.0, released_n - trial.normal));
    return {released_n, (shear > 0 ? 1 - held / shear : 0.0) * trial.tangential};
}

/// Full separation: relax the crack, return what is left to the yield surface, relax what the return put on the crack.
/// The crack goes first, so that free opening is never taken for plastic strain.
void slide(const SeparationLaw& law, Traction before, const Vec& n, DecohesionStep& result)
{
    // Without cohesion only friction dissipates: the trapezoid of an opening and closing normal traction is left out.
    const auto relax = [&] {
        const Traction trial = traction_on(result.stress, n);
        const Traction released = unsupported(law, result.crack, trial);
        before.normal = released.normal - trial.normal; // makes the normal part of the trapezoid exactly zero
        open(law, before, trial, released, n, result);
        before = {trial.normal - released.normal, trial.tangential - released.tangential};
    };
    relax();
    if (!law.plastic) return;
    const PlasticStep<double> returned = radial_return(result.stress, result.eq_plastic_strain, *law.plastic);
    result.stress = returned.stress;
    result.eq_plastic_strain = returned.eq_plastic_strain;
    result.plastic_work = returned.work;
    if (returned.work > 0) relax();
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
    law.friction = decohesion.friction;
    return law;
}

DecohesionStep separate(const SeparationLaw& law, const core::Crack& crack, const StrainStep& step)
{
    CLEAVE_EXPECTS(crack.effective_length > 0);
    const Vec turned = step.rotation * Vec{crack.normal};
    const Vec n = (1 / std::sqrt(core::dot(turned, turned))) * turned;
    const Sym old = core::rotated(step.rotation, step.stress);

    DecohesionStep result{elastic_trial(old, step.strain, law.lame), crack, step.eq_plastic_strain, 0, 0};
    result.crack.normal = n.v;
    result.crack.slip = (step.rotation * Vec{crack.slip}).v;
    const Traction before = traction_on(old, n);
    if (crack.damage >= 1) {
        slide(law, before, n, result);
        return result;
    }
    const Traction trial = traction_on(result.stress, n);
    const bool brittle = law.drop_speed > 0 && crack.snap_back_ratio >= 1;
    const Traction released = brittle ? dropped(law, result.crack, trial, step.dt) : softened(law, result.crack, trial);
    open(law, before, trial, released, n, result);
    if (result.crack.damage >= 1) result.crack.separation_time = step.time;
    return result;
}
} // namespace material
