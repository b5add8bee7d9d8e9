#include "material/renewed_plane.h"

#include "material/band_width.h"
#include "material/crack_plane.h"
#include "material/decohesion.h"
#include "material/principal.h"
#include "material/rotation.h"

#include <algorithm>
#include <cmath>

namespace material
{
namespace
{
/// No plane is loaded more than this: see material/onset.h.
double largest_loading(const core::Crack& crack, const core::Sym<double>& stress)
{
    const double mean = core::trace(stress) / 3;
    const double shear = std::sqrt(std::max(0.0, 0.5 * (core::contract(stress, stress) - 3 * mean * mean)));
    return loading(crack, {mean + 2 / std::sqrt(3.0) * shear, shear});
}
} // namespace

void renew_plane(const core::Crack& crack, const StrainStep& step, Faces<double>& faces)
{
    if (largest_loading(crack, faces.stress) <= renewal_loading) return;
    const core::Vec<double> normal = crack_normal(static_cast<Mode>(crack.mode), principal(faces.stress),
                                                  {gradient_increment(step.strain, step.spin), faces.normal});
    if (loading(crack, plane_traction(faces.stress, normal)) <= renewal_loading) return;
    faces.effective_length *= band_width(normal) / band_width(faces.normal);
    faces.slip = faces.slip - core::dot(faces.slip, normal) * normal;
    faces.normal = normal;
}
} // namespace material
