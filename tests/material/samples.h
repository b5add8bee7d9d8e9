/// Inputs shared by the material tests: the paper's steel and reproducible random tensors.
#pragma once

#include "core/tensor.h"
#include "material/material.h"
#include "material/rotation.h"

#include <cmath>
#include <random>

namespace material
{
using Sym = core::Sym<double>;
using Vec = core::Vec<double>;
using Mat = core::Mat<double>;

inline Elastic steel()
{
    return {7.81e-3, 195e3, 0.3};
}
inline VonMises steel_plastic()
{
    return {620, 1150};
}

inline double norm(const Sym& a)
{
    return std::sqrt(core::contract(a, a));
}
inline double norm(const Vec& a)
{
    return std::sqrt(core::dot(a, a));
}

/// von Mises equivalent stress.
inline double equivalent(const Sym& stress)
{
    const double mean = core::trace(stress) / 3;
    const Sym s = stress - Sym{{mean, mean, mean, 0, 0, 0}};
    return std::sqrt(1.5 * core::contract(s, s));
}

class Samples
{
public:
    double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    Vec vector(double size) { return {{uniform(-size, size), uniform(-size, size), uniform(-size, size)}}; }
    Sym tensor(double size)
    {
        Sym a{};
        for (int i = 0; i < 6; ++i) a[i] = uniform(-size, size);
        return a;
    }
    Mat matrix(double size)
    {
        Mat a{};
        for (double& entry : a.m) entry = uniform(-size, size);
        return a;
    }
    Mat rotation() { return incremental_rotation(vector(3)); }

private:
    std::mt19937 engine_{20140101};
};

inline Mat transposed(const Mat& a)
{
    return {{a(0, 0), a(1, 0), a(2, 0), a(0, 1), a(1, 1), a(2, 1), a(0, 2), a(1, 2), a(2, 2)}};
}

/// sym(a b^T)
inline Sym dyad(const Vec& a, const Vec& b)
{
    Mat m{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) m(i, j) = a[i] * b[j];
    return core::symmetric_part(m);
}
} // namespace material
