/// A softening crack whose plane is chosen again (key `renewed_plane`, docs/decisions/023).
///
/// The plane is fixed in the material when the crack begins. Where the loading turns, or where what strains the cell
/// runs along the plane, the traction across it goes on falling and the stress on other planes grows without bound:
/// fixed-crack locking (methods.md B14). When the stress loads another plane beyond the full strength again,
///
///   phi(n') = sqrt((<tau_n>/tau_nf)^2 + (|tau_t|/tau_tf)^2) > 1.05,
///
/// n' the plane that a new crack of this mode would take, the crack goes on there with the damage it has. What it has
/// opened stays: the opening of the old plane is strain that stress has been relaxed by.
#pragma once

#include "core/crack.h"
#include "material/crack_faces.h"
#include "material/separation.h"

namespace material
{
/// Overshoot of the strength that calls for a new plane [1]: what B14 allows a fixed one.
inline constexpr double renewal_loading = 1.05;

/// Give `faces` the plane the stress asks for, with its slip turned into it and L_e of its own; nothing where the plane
/// there is does.
/// @param crack  damage < 1: mode and strengths
void renew_plane(const core::Crack& crack, const StrainStep& step, Faces<double>& faces);
} // namespace material
