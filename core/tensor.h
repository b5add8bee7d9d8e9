/// 3-vectors, 3x3 matrices and symmetric tensors over any scalar T: double, float, or a pack of SIMD lanes.
///
/// Eigen serves the cold code; these plain structs serve the kernels, where T is a core::Pack and every lane is
/// another particle. Symmetric tensors are stored xx, yy, zz, xy, yz, zx; off-diagonal entries are tensor
/// components (not engineering shear).
#pragma once

#include <array>

namespace core
{
template <class T>
struct Vec
{
    std::array<T, 3> v;
    constexpr T& operator[](int i) { return v[static_cast<unsigned>(i)]; }
    constexpr const T& operator[](int i) const { return v[static_cast<unsigned>(i)]; }
};

/// Row-major 3x3 matrix: m(i, j).
template <class T>
struct Mat
{
    std::array<T, 9> m;
    constexpr T& operator()(int i, int j) { return m[static_cast<unsigned>(3 * i + j)]; }
    constexpr const T& operator()(int i, int j) const { return m[static_cast<unsigned>(3 * i + j)]; }
};

/// Symmetric tensor xx, yy, zz, xy, yz, zx.
template <class T>
struct Sym
{
    std::array<T, 6> s;
    constexpr T& operator[](int i) { return s[static_cast<unsigned>(i)]; }
    constexpr const T& operator[](int i) const { return s[static_cast<unsigned>(i)]; }
    /// Position of component (i, j) in the storage order.
    static constexpr int at(int i, int j)
    {
        constexpr int table[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};
        return table[3 * i + j];
    }
    constexpr const T& operator()(int i, int j) const { return s[static_cast<unsigned>(at(i, j))]; }
};

template <class T>
constexpr Mat<T> identity()
{
    return {{T(1), T(0), T(0), T(0), T(1), T(0), T(0), T(0), T(1)}};
}

template <class T>
constexpr T dot(const Vec<T>& a, const Vec<T>& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
constexpr Vec<T> cross(const Vec<T>& a, const Vec<T>& b)
{
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

template <class T>
constexpr Vec<T> operator+(const Vec<T>& a, const Vec<T>& b)
{
    return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}};
}

template <class T>
constexpr Vec<T> operator-(const Vec<T>& a, const Vec<T>& b)
{
    return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
}

template <class T>
constexpr Vec<T> operator*(const T& a, const Vec<T>& b)
{
    return {{a * b[0], a * b[1], a * b[2]}};
}

template <class T>
constexpr T determinant(const Mat<T>& a)
{
    return a(0, 0) * (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)) - a(0, 1) * (a(1, 0) * a(2, 2) - a(1, 2) * a(2, 0)) +
           a(0, 2) * (a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0));
}

/// Cofactor matrix: cof(A) = det(A) A^{-T}.
template <class T>
constexpr Mat<T> cofactor(const Mat<T>& a)
{
    return {{a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1), a(1, 2) * a(2, 0) - a(1, 0) * a(2, 2),
             a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0), a(0, 2) * a(2, 1) - a(0, 1) * a(2, 2),
             a(0, 0) * a(2, 2) - a(0, 2) * a(2, 0), a(0, 1) * a(2, 0) - a(0, 0) * a(2, 1),
             a(0, 1) * a(1, 2) - a(0, 2) * a(1, 1), a(0, 2) * a(1, 0) - a(0, 0) * a(1, 2),
             a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0)}};
}

template <class T>
constexpr Mat<T> operator*(const Mat<T>& a, const Mat<T>& b)
{
    Mat<T> c; // uninitialised on purpose: zeroing 9 vectors of lanes is not free
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) c(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
    return c;
}

template <class T>
constexpr Vec<T> operator*(const Mat<T>& a, const Vec<T>& b)
{
    return {{a(0, 0) * b[0] + a(0, 1) * b[1] + a(0, 2) * b[2], a(1, 0) * b[0] + a(1, 1) * b[1] + a(1, 2) * b[2],
             a(2, 0) * b[0] + a(2, 1) * b[1] + a(2, 2) * b[2]}};
}

template <class T>
constexpr Vec<T> operator*(const Sym<T>& a, const Vec<T>& b)
{
    return {{a[0] * b[0] + a[3] * b[1] + a[5] * b[2], a[3] * b[0] + a[1] * b[1] + a[4] * b[2],
             a[5] * b[0] + a[4] * b[1] + a[2] * b[2]}};
}

template <class T>
constexpr Sym<T> operator+(const Sym<T>& a, const Sym<T>& b)
{
    return {{a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4] + b[4], a[5] + b[5]}};
}

template <class T>
constexpr Sym<T> operator-(const Sym<T>& a, const Sym<T>& b)
{
    return {{a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3], a[4] - b[4], a[5] - b[5]}};
}

template <class T>
constexpr Sym<T> operator*(const T& a, const Sym<T>& b)
{
    return {{a * b[0], a * b[1], a * b[2], a * b[3], a * b[4], a * b[5]}};
}

template <class T>
constexpr T trace(const Sym<T>& a)
{
    return a[0] + a[1] + a[2];
}

/// Double contraction a : b.
template <class T>
constexpr T contract(const Sym<T>& a, const Sym<T>& b)
{
    const T off = a[3] * b[3] + a[4] * b[4] + a[5] * b[5];
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + (off + off);
}

/// Symmetric part of a matrix.
template <class T>
constexpr Sym<T> symmetric_part(const Mat<T>& a)
{
    const T half = T(0.5);
    return {{a(0, 0), a(1, 1), a(2, 2), half * (a(0, 1) + a(1, 0)), half * (a(1, 2) + a(2, 1)),
             half * (a(2, 0) + a(0, 2))}};
}

/// R a R^T.
template <class T>
constexpr Sym<T> rotated(const Mat<T>& r, const Sym<T>& a)
{
    Mat<T> ra;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) ra(i, j) = r(i, 0) * a(0, j) + r(i, 1) * a(1, j) + r(i, 2) * a(2, j);
    const auto entry = [&](int i, int j) { return ra(i, 0) * r(j, 0) + ra(i, 1) * r(j, 1) + ra(i, 2) * r(j, 2); };
    return {{entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(2, 0)}};
}
} // namespace core
