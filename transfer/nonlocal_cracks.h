/// Cracks about a cell that may start: which lead into it and which forbid it (transfer/nonlocal_onset.h).
#pragma once

#include "transfer/nonlocal_view.h"

#include <array>
#include <vector>

namespace transfer
{
/// Velocity gradient [1/ms] and deformation gradient (total formulation, else unity) in the middle of a cell.
struct CellMotion
{
    core::Mat<Real> velocity_gradient, deformation;
};

CellMotion motion_of(const NonlocalView& view, const particles::Particles& particles, std::size_t slot);

/// Normal at rest [1], N ~ F^T n.
Vec3 at_rest(const core::Mat<Real>& deformation, const std::array<Real, 3>& normal);

/// Cell with a crack, or its image in a symmetry plane: the crack of its first separating particle.
struct Neighbour
{
    Vec3 offset; // mm, to the cell asked about
    std::size_t slot;
    std::array<Real, 3> normal; // 1
    Real effective_length;      // mm
};

/// Cells with a crack, and their images, within `reach` [mm] of a cell's centre.
std::vector<Neighbour> cracks_near(const NonlocalView& view, const particles::Particles& particles, std::size_t slot,
                                   Real reach);

/// Share of what is left of its strength below which a crack does not soften [1]. Cracks in line carry the same
/// traction, so those that soften are near 1 and those that were passed by far below: in the challenge specimen nine
/// tenths are above 0.76, the others below 0.4.
inline constexpr Real idle_loading = 0.5;

/// Some crack of the cell takes up what strains the metal there: it is not through, and loaded to at least
/// `idle_loading` of what is left of its strength.
bool softens(const NonlocalView& view, const particles::Particles& particles, std::size_t slot);

/// Unit vectors at rest along which cracks of neighbouring cells lead into this one: in their planes, which are less
/// than 45 degrees off the way to it.
std::vector<Vec3> arriving_cracks(const NonlocalView& view, const particles::Particles& particles, std::size_t slot);

/// Two planes side by side: distance along the normal of the crack beyond half a band but within `reach`, offset along
/// the plane less than a band, and normals less than 45 degrees apart.
/// @param offset  mm, from the crack to the new plane, at rest
/// @param normal  1, of the crack, at rest
/// @param fresh   1, normal of the new plane, at rest
/// @param band    mm, the larger L_e of the two
bool excluded(const Vec3& offset, const Vec3& normal, const Vec3& fresh, Real band, Real reach);
} // namespace transfer
