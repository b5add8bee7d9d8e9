#include "material/rotating_crack.h"

#include "material/principal.h"

#include <cmath>

namespace material
{
namespace
{
using Vec = core::Vec<double>;
using Sym = core::Sym<double>;

double sum_of_components(const Vec& n)
{
    return std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]);
}

/// C^-1 sigma.
Sym elastic_strain(const SeparationLaw& law, const Sym& stress)
{
    const double two_mu = law.lame.shear_two, trace = stress[0] + stress[1] + stress[2];
    const double volumetric = law.lame.lame * trace / (two_mu * (two_mu + 3 * law.lame.lame));
    Sym strain = (1 / two_mu) * stress;
    for (int i = 0; i < 3; ++i) strain[i] -= volumetric;
    return strain;
}

/// sigma : C^-1 sigma / 2.
double elastic_energy(const SeparationLaw& law, const Sym& stress)
{
    return 0.5 * core::contract(stress, elastic_strain(law, stress));
}

/// sym(a b).
Sym dyad(const Vec& a, const Vec& b)
{
    Sym result{};
    for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j) result[Sym::at(i, j)] = 0.5 * (a[i] * b[j] + a[j] * b[i]);
    return result;
}
} // namespace

double rotate_to_strain(const SeparationLaw& law, Faces<double>& faces)
{
    const double spacing = faces.effective_length / sum_of_components(faces.normal);
    const Sym strain = elastic_strain(law, faces.stress) +
                       (1 / faces.effective_length) * dyad(faces.normal, faces.opening * faces.normal + faces.slip);
    Vec normal = principal(strain).direction[0];
    if (core::dot(normal, faces.normal) < 0) normal = -1.0 * normal;

    const double before = elastic_energy(law, faces.stress);
    faces.normal = normal;
    faces.slip = {};
    faces.effective_length = spacing * sum_of_components(normal);
    faces.stress =
        elastic_trial(Sym{}, strain - (faces.opening / faces.effective_length) * dyad(normal, normal), law.lame);
    return before - elastic_energy(law, faces.stress);
}
} // namespace material
