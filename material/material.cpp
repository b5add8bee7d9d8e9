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
    return stored_energy<double>(elastic.lame(), elastic.shear_modulus(), stress);
}
} // namespace material
