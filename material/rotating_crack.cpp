#include "material/rotating_crack.h"

#include "material/band_width.h"
#include "material/principal.h"

namespace material
{
namespace
{
/// What the opening of `faces` takes from the traction, Q u / L_e.
Traction<double> taken_by_opening(const SeparationLaw& law, const Faces<double>& faces)
{
    return {law.wave_modulus * faces.opening / faces.effective_length,
            (law.shear_modulus / faces.effective_length) * faces.slip};
}

/// Elastic energy [mJ/mm^3] that a crack frees when it opens from `closed` and takes `taken`: the mean traction times u
/// / L_e.
double freed(const SeparationLaw& law, const Traction<double>& closed, const Traction<double>& taken)
{
    return (closed.normal - 0.5 * taken.normal) * taken.normal / law.wave_modulus +
           core::dot(closed.tangential - 0.5 * taken.tangential, taken.tangential) / law.shear_modulus;
}
} // namespace

double rotate_to_strain(const SeparationLaw& law, Faces<double>& faces)
{
    const Traction<double> old = taken_by_opening(law, faces);
    // C e, the stress were the crack closed: it has the principal directions of e.
    const core::Sym<double> closed = relaxed(law, faces.stress, faces.normal, {-old.normal, -1.0 * old.tangential});
    const double before = freed(law, traction_on(closed, faces.normal), old);

    core::Vec<double> normal = principal(closed).direction[0];
    if (core::dot(normal, faces.normal) < 0) normal = -1.0 * normal;
    // The strain of the opening stays, not its width: energy is then freed, never taken, by turning.
    const double widths = band_width(normal) / band_width(faces.normal);
    faces.effective_length *= widths;
    faces.opening *= widths;
    faces.normal = normal;
    faces.slip = {};
    const Traction<double> now = taken_by_opening(law, faces);
    faces.stress = relaxed(law, closed, normal, now);
    return freed(law, traction_on(closed, normal), now) - before;
}
} // namespace material
