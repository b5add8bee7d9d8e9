#include "material/decohesion.h"

#include "core/contract.h"
#include "material/band_width.h"
#include "material/onset.h"

#include <algorithm>
#include <cmath>

namespace material
{
namespace
{
double mode_ratio(const Decohesion& law, Mode mode)
{
    switch (mode) {
    case Mode::opening:
        return law.c_m_opening;
    case Mode::shear:
        return law.c_m_shear;
    case Mode::mixed:
        break;
    }
    return law.c_m_mixed;
}

/// tau_nf that puts a traction on the loading surface, eq. (9) with tau_tf = c_m tau_nf; compression does not load it.
double normal_strength(const PlaneTraction& traction, double c_m)
{
    return std::hypot(std::max(traction.normal, 0.0), traction.shear / c_m);
}

double normal_strength(const Decohesion& law, Mode mode, const core::Vec<double>& normal, const Principal& principal,
                       const core::Sym<double>& test_stress, const core::Sym<double>& stress)
{
    const double c_m = mode_ratio(law, mode);
    if (law.onset_strength == OnsetStrength::paper) // eq. (10)
        return normal_strength({principal.value[0], (principal.value[0] - principal.value[2]) / 2}, c_m);
    return std::max(normal_strength(plane_traction(test_stress, normal), c_m),
                    normal_strength(plane_traction(stress, normal), c_m));
}

/// Shares of the loading surface, (tau_i / tau_if)^2.
struct Loading
{
    double normal = 0;
    double shear = 0;
    double total() const { return normal + shear; }
};

Loading shares_of_loading(const core::Crack& crack, const PlaneTraction& traction)
{
    const double normal = std::max(traction.normal, 0.0) / crack.normal_strength;
    const double shear = traction.shear / crack.tangential_strength;
    return {normal * normal, shear * shear};
}

/// U_0 [N/mm] the case asks for (D.11 item 4): reading R1, tau_0 the strength of the active mode; or the fracture
/// energy of the mode, mixed in proportion to the shear share of the loading.
double nominal_surface_energy(const Decohesion& law, Mode mode, const core::Crack& crack, const Loading& load)
{
    if (law.u0) return *law.u0 * (mode == Mode::shear ? crack.tangential_strength : crack.normal_strength);
    CLEAVE_EXPECTS(law.energy_1 || law.energy_2);
    const double opening = law.energy_1 ? *law.energy_1 : *law.energy_2;
    const double shear = law.energy_2 ? *law.energy_2 : *law.energy_1;
    const double share = mode == Mode::opening ? 0 : mode == Mode::shear ? 1 : load.shear / load.total();
    return (opening + share * (shear - opening)) * (law.q + 1) / law.q;
}

std::optional<Mode> failing_mode(bool opens, bool shears)
{
    if (opens && shears) return Mode::mixed;
    if (opens) return Mode::opening;
    if (shears) return Mode::shear;
    return std::nullopt;
}
} // namespace

PlaneTraction plane_traction(const core::Sym<double>& stress, const core::Vec<double>& normal)
{
    const core::Vec<double> traction = stress * normal;
    const double along = core::dot(traction, normal);
    const core::Vec<double> tangential = traction - along * normal;
    return {along, std::sqrt(core::dot(tangential, tangential))};
}

double loading(const core::Crack& crack, const PlaneTraction& traction)
{
    return std::sqrt(shares_of_loading(crack, traction).total());
}

bool may_start(const Decohesion& law, const core::Sym<double>& stress)
{
    return may_start(stress, law.s_max, least_shear_strength(law));
}

double lode_parameter(const Principal& stress)
{
    return lode_parameter(stress.value[0], stress.value[1], stress.value[2]);
}

double onset_ratio(const Decohesion& law, const Principal& stress, double lode)
{
    const auto [s1, s2, s3] = stress.value;
    return std::max(s1 / law.s_max, (s1 - s3) / (2 * shear_strength(lode, law.tau_max, axial_rise(law))));
}

double onset_ratio(const Decohesion& law, const PlaneTraction& traction)
{
    return std::max(traction.normal / law.s_max, traction.shear / law.tau_max);
}

std::optional<Mode> failing_mode(const Decohesion& law, const PlaneTraction& traction)
{
    return failing_mode(traction.normal > law.s_max, traction.shear > law.tau_max);
}

std::optional<Mode> failing_mode(const Decohesion& law, const Principal& stress, double lode)
{
    const auto [s1, s2, s3] = stress.value;
    return failing_mode(s1 > law.s_max, (s1 - s3) / 2 > shear_strength(lode, law.tau_max, axial_rise(law)));
}

std::optional<core::Crack> onset(const Decohesion& law, const Elastic& elastic, const core::Sym<double>& test_stress,
                                 const core::Sym<double>& stress, const Bias& bias, double spacing, double time,
                                 std::optional<double> lode)
{
    CLEAVE_EXPECTS(law.q > 0 && spacing > 0);
    const Principal principal_stress = principal(test_stress);
    const std::optional<Mode> mode =
        law.weak_plane ? failing_mode(law, plane_traction(test_stress, {*law.weak_plane}))
                       : failing_mode(law, principal_stress, lode.value_or(lode_parameter(principal_stress)));
    if (!mode) return std::nullopt;

    const core::Vec<double> normal =
        law.weak_plane ? core::Vec<double>{*law.weak_plane} : crack_normal(*mode, principal_stress, bias);
    core::Crack crack;
    crack.mode = static_cast<std::int32_t>(*mode);
    crack.normal = normal.v;
    crack.onset_time = time;
    crack.normal_strength = normal_strength(law, *mode, normal, principal_stress, test_stress, stress);
    crack.tangential_strength = mode_ratio(law, *mode) * crack.normal_strength;
    crack.effective_length = law.band_factor * spacing * band_width(normal);

    // Which traction softens: the one that met the criterion. The particle's own may still be far below it.
    const PlaneTraction starting = plane_traction(test_stress, normal);
    const PlaneTraction own = plane_traction(stress, normal);
    crack.drop_traction = {std::max(own.normal, 0.0), own.shear};
    crack.surface_energy = nominal_surface_energy(law, *mode, crack, shares_of_loading(crack, starting));
    const double stable_length = critical_length(elastic, law.q, crack, starting);
    crack.snap_back_ratio = crack.effective_length / stable_length;
    // S2: L_crit grows in proportion to U_0, so this leaves B_s = 1 / kappa (D.7).
    if (law.snap_back == SnapBack::energy_floor)
        crack.surface_energy *= std::max(1.0, law.energy_floor_factor * crack.snap_back_ratio);
    return crack;
}

double critical_length(const Elastic& elastic, double q, const core::Crack& crack, const PlaneTraction& traction)
{
    const Loading load = shares_of_loading(crack, traction);
    const double normal_strength = crack.normal_strength, shear_strength = crack.tangential_strength;
    const double stiffness = elastic.wave_modulus() * load.normal / (normal_strength * normal_strength) +
                             elastic.shear_modulus() * load.shear / (shear_strength * shear_strength);
    return crack.surface_energy * stiffness / (load.total() * q);
}

double fracture_energy(double q, const core::Crack& crack)
{
    return crack.surface_energy * q / (q + 1);
}

double softening_energy(double q, const core::Crack& crack)
{
    return crack.surface_energy * (crack.damage - std::pow(crack.damage, q + 1) / (q + 1));
}
} // namespace material
