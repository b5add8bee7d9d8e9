/// Objective rotation of a stress over one step: Hughes-Winget, the incremental form of the Jaumann rate.
///
///   R = (I - w/2)^{-1} (I + w/2) = I + (w + w^2/2) / (1 + |a|^2/4),   w = W dt,   w x = a cross x
///
/// The Cayley form is exactly orthogonal, so core::rotated(R, sigma) keeps every invariant of sigma (methods.md B20;
/// forward-Euler Jaumann lets the deviator grow). Phase error per step O(|a|^3). T is double or a core::Pack of lanes.
/// Source: Hughes & Winget 1980, Int. J. Numer. Meth. Eng. 15:1862.
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
} // namespace material
