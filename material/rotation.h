/// Objective rotation of a stress over one step: Hughes-Winget, the incremental form of the Jaumann rate.
///
///   R = (I - w/2)^{-1} (I + w/2) = I + (w + w^2/2) / (1 + |a|^2/4),   w = W dt,   w x = a cross x
///
/// The Cayley form is exactly orthogonal, so core::rotated(R, sigma) keeps every invariant of sigma (methods.md B20;
/// forward-Euler Jaumann lets the deviator grow). Phase error per step O(|a|^3). The strain increment D dt belongs to
/// the axes of mid-step and has to be turned on by the other half of R before it is added (at_end_of_step): left out,
/// as often, the stress is of first order in dt, and a body that spins and vibrates gains energy without bound. T is
/// double or a core::Pack of lanes. Source: Hughes & Winget 1980, Int. J. Numer. Meth. Eng. 15:1862.
#pragma once

#include "core/simd.h"
#include "core/tensor.h"

namespace material
{
/// Axial vector a [1] of the skew part of a velocity-gradient increment L dt [1].
template <class T>
constexpr core::Vec<T> spin_increment(const core::Mat<T>& gradient_increment)
{
    const core::Mat<T>& g = gradient_increment;
    const T half = T(0.5);
    return {{half * (g(2, 1) - g(1, 2)), half * (g(0, 2) - g(2, 0)), half * (g(1, 0) - g(0, 1))}};
}

/// The increment L dt [1] that strain e and spin a are the symmetric and the skew part of.
template <class T>
constexpr core::Mat<T> gradient_increment(const core::Sym<T>& e, const core::Vec<T>& a)
{
    return {{e[0], e[3] - a[2], e[5] + a[1], e[3] + a[2], e[1], e[4] - a[0], e[5] - a[1], e[4] + a[0], e[2]}};
}

/// Spin [1] of the material plane with unit normal n, from spin a and strain D of the same increment:
///
///   dn = -(L^T n) without its part along n,   spin about n as the material's   =>   a - n x (D n)
///
/// Motion of the two sides of the plane against each other, L = u (x) n, does not turn it (n is F^{-T} N over its
/// length), whereas a itself is half of the slip: a band of cells that slips by its own width would turn its plane by
/// half a radian and lock.
template <class T>
constexpr core::Vec<T> plane_spin(const core::Vec<T>& a, const core::Sym<T>& strain, const core::Vec<T>& normal)
{
    return a - core::cross(normal, strain * normal);
}

/// Rotation matrix R [1] of the spin increment a [1]; one division.
template <class T>
constexpr core::Mat<T> incremental_rotation(const core::Vec<T>& a)
{
    const T xx = a[0] * a[0], yy = a[1] * a[1], zz = a[2] * a[2];
    const T scale = T(1) / (T(1) + T(0.25) * (xx + yy + zz));
    const T half = T(0.5) * scale;
    const T x = scale * a[0], y = scale * a[1], z = scale * a[2];
    const T xy = half * a[0] * a[1], yz = half * a[1] * a[2], zx = half * a[2] * a[0];
    return {{T(1) - half * (yy + zz), xy - z, zx + y, xy + z, T(1) - half * (xx + zz), yz - x, zx - y, yz + x,
             T(1) - half * (xx + yy)}};
}

/// Strain increment e [1] of mid-step in the axes of the end of the step: e + (w e - e w) / 2, a the spin increment
/// [1]. Its trace is that of e; O(|a|^2 e) from a turn by half of R.
template <class T>
constexpr core::Sym<T> at_end_of_step(const core::Sym<T>& e, const core::Vec<T>& a)
{
    const T half = T(0.5);
    const T x = half * a[0], y = half * a[1], z = half * a[2];
    const T on_x = a[0] * e[4], on_y = a[1] * e[5], on_z = a[2] * e[3];
    return {{e[0] + (on_y - on_z), e[1] + (on_z - on_x), e[2] + (on_x - on_y),
             e[3] + (z * (e[0] - e[1]) + (y * e[4] - x * e[5])), e[4] + (x * (e[1] - e[2]) + (z * e[5] - y * e[3])),
             e[5] + (y * (e[2] - e[0]) + (x * e[3] - z * e[4]))}};
}
} // namespace material
