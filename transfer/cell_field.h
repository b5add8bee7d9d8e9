/// The trilinear velocity field of one cell as a polynomial, evaluated for lanes of particles.
///
/// v(xi, eta, zeta) = c0 + c1 xi + c2 eta + c3 zeta + c4 xi eta + c5 eta zeta + c6 zeta xi + c7 xi eta zeta, with xi,
/// eta, zeta in [0, 1]. The eight coefficients of all six node quantities (velocity, change) come from 19 vector
/// differences; value and gradient of one component then cost 13 multiply-adds. Differences of equal node values are
/// exactly zero, so a rigid translation strains nothing.
#pragma once

#include "core/simd.h"
#include "core/tensor.h"
#include "grid/levels.h"

namespace transfer
{
/// Columns of CellField::coefficient.
inline constexpr int velocity_column = 0;
inline constexpr int change_column = 4;

struct CellField
{
    alignas(64) Real coefficient[8][8]; // [monomial][node quantity]
};

/// @param node  the cell's lower-corner node in a motion tile
[[gnu::always_inline]] inline void read_cell(const grid::NodeMotion* node, CellField& field)
{
    using Line = core::Pack<Real, 8>;
    const auto at = [&](int i, int j, int k) { return Line::load(node[grid::tile_index(i, j, k)].velocity.data()); };
    const Line n000 = at(0, 0, 0), n001 = at(0, 0, 1), n010 = at(0, 1, 0), n011 = at(0, 1, 1);
    const Line n100 = at(1, 0, 0), n101 = at(1, 0, 1), n110 = at(1, 1, 0), n111 = at(1, 1, 1);
    const Line x = n100 - n000, y = n010 - n000, z = n001 - n000;
    const Line xy = (n110 - n010) - x, yz = (n011 - n001) - y, zx = (n101 - n001) - x;
    const Line xyz = ((n111 - n011) - (n101 - n001)) - xy;
    n000.store(field.coefficient[0]);
    x.store(field.coefficient[1]);
    y.store(field.coefficient[2]);
    z.store(field.coefficient[3]);
    xy.store(field.coefficient[4]);
    yz.store(field.coefficient[5]);
    zx.store(field.coefficient[6]);
    xyz.store(field.coefficient[7]);
}

/// Position inside a cell, each coordinate in [0, 1].
template <class V>
struct LocalPosition
{
    V xi, eta, zeta;
};

template <class V>
[[gnu::always_inline]] inline V value(const CellField& field, int column, const LocalPosition<V>& at)
{
    const auto c = [&](int m) { return V(field.coefficient[m][column]); };
    const V eta_slope = c(4) + at.zeta * c(7);
    const V d_xi = c(1) + at.eta * eta_slope + at.zeta * c(6);
    return c(0) + at.xi * d_xi + at.eta * (c(2) + at.zeta * c(5)) + at.zeta * c(3);
}

/// Derivatives with respect to xi, eta, zeta (multiply by 1 / spacing for the gradient), and the value.
template <class V>
[[gnu::always_inline]] inline V value_and_slopes(const CellField& field, int column, const LocalPosition<V>& at,
                                                 V& d_xi, V& d_eta, V& d_zeta)
{
    const auto c = [&](int m) { return V(field.coefficient[m][column]); };
    const V mixed = c(5) + at.xi * c(7);
    d_xi = c(1) + at.eta * (c(4) + at.zeta * c(7)) + at.zeta * c(6);
    d_eta = c(2) + at.xi * c(4) + at.zeta * mixed;
    d_zeta = c(3) + at.xi * c(6) + at.eta * mixed;
    return c(0) + at.xi * d_xi + at.eta * (c(2) + at.zeta * c(5)) + at.zeta * c(3);
}
} // namespace transfer
