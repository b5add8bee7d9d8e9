#include "material/material.h"

#include "material/elastic.h"

#include <cmath>

namespace material
{
Real Elastic::wave_speed() const
{
    return std::sqrt(wave_modulus() / density);
}

double elastic_energy(const Elastic& elastic, const core::Sym<double>& stress)
{
    const double mean = core::trace(stress) / 3;
    const core::Sym<double> deviator = stress - core::Sym<double>{{mean, mean, mean, 0, 0, 0}};
    return mean * mean / (2 * elastic.bulk_modulus()) +
           core::contract(deviator, deviator) / (4 * elastic.shear_modulus());
}
} // namespace material
