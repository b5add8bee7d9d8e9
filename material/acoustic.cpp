#include "material/acoustic.h"

#include "core/contract.h"
#include "material/principal.h"

#include <algorithm>
#include <cmath>

namespace material
{
Bifurcation bifurcation(const Elastic& elastic, double plastic_modulus, const core::Sym<double>& stress)
{
    const double mu = elastic.shear_modulus(), nu = elastic.poisson_ratio;
    CLEAVE_EXPECTS(plastic_modulus > -3 * mu);
    const Principal principal_stress = principal(stress);
    const auto [s1, s2, s3] = principal_stress.value;
    const double mean = (s1 + s2 + s3) / 3;
    const double norm = std::hypot(s1 - mean, s2 - mean, s3 - mean);
    CLEAVE_EXPECTS(norm > 0);
    const double d1 = (s1 - mean) / norm, d2 = (s2 - mean) / norm, d3 = (s3 - mean) / norm;

    // m = n_1^2; -(1 - nu) d_2 lies between d_3 and d_1 for every stress, since 0 <= 1 - nu <= 2.
    const double m = std::clamp((-(1 - nu) * d2 - d3) / (d1 - d3), 0.0, 1.0);
    Bifurcation result;
    result.normal = std::sqrt(m) * principal_stress.direction[0] - std::sqrt(1 - m) * principal_stress.direction[2];
    const double along = m * d1 + (1 - m) * d3;
    const double bracket = m * d1 * d1 + (1 - m) * d3 * d3 - along * along / (2 * (1 - nu));
    result.ratio = 1 - 6 * mu / (3 * mu + plastic_modulus) * bracket;
    result.critical_hardening = 3 * mu * (2 * bracket - 1);
    return result;
}
} // namespace material
