/// Velocity gradient from the change of F over a step.
#pragma once

#include "core/real.h"
#include "core/tensor.h"

namespace transfer
{
/// L dt = dF F^{-1} with F in the middle of the step; `jacobian` becomes det F there. T is a core::Pack.
template <class T>
[[gnu::always_inline]] inline core::Mat<T> middle_gradient(const core::Mat<T>& increment, const core::Mat<T>& middle,
                                                           T& jacobian)
{
    const core::Mat<T> cof = core::cofactor(middle);
    jacobian = middle(0, 0) * cof(0, 0) + middle(0, 1) * cof(0, 1) + middle(0, 2) * cof(0, 2);
    const T per_jacobian = T(Real(1)) / jacobian;
    core::Mat<T> l;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            l(i, j) = per_jacobian *
                      (increment(i, 0) * cof(j, 0) + increment(i, 1) * cof(j, 1) + increment(i, 2) * cof(j, 2));
    return l;
}
} // namespace transfer
