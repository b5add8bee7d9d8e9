/// A crack plane that follows the strain while little is broken: rotating crack with a fixed end.
///
/// Elastic strain and opening together are e = C^-1 sigma + sym(n u) / L_e. The plane is turned to the largest
/// principal value of e, all opening becomes normal opening there, and e stays what it is:
///
///   n <- e_1(e),  L_e <- c_b h sum |n_i|,  u <- (u_n / L_e) L_e n,  sigma <- C (e - u_n n n / L_e)
///
/// Where the principal stresses at onset are nearly equal (ahead of a mode I tip) the first plane is arbitrary, and a
/// plane fixed there locks: it never sees the stress along it. The strain that opens the crack decides soon. Source:
/// Jirasek & Zimmermann 1998 (J. Eng. Mech. 124, 277: rotating crack with transition), Rots 1988.
#pragma once

#include "material/crack_faces.h"

namespace material
{
/// Turn the plane of `faces` in its trial state; the elastic energy that this frees [mJ/mm^3] is returned: dissipated.
double rotate_to_strain(const SeparationLaw& law, Faces<double>& faces);
} // namespace material
