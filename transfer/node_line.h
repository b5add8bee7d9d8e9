/// The eight quantities of a node as one value.
#pragma once

#include "core/simd.h"
#include "transfer/chunk.h"

namespace transfer
{
/// One lane per quantity of a node, a cache line, in as many vectors as the instruction set needs for it. (Of one pack
/// wider than the hardware the compiler makes shuffles number by number.)
struct NodeLine
{
    static constexpr int piece = Lanes::lanes;
    static constexpr int pieces = 8 / piece;
    Lanes part[pieces];

    NodeLine() = default;
    [[gnu::always_inline]] explicit NodeLine(Lanes same)
    {
        for (Lanes& p : part) p = same;
    }
    [[gnu::always_inline]] explicit NodeLine(Real same) : NodeLine(Lanes(same)) {}

    [[gnu::always_inline]] static NodeLine load(const Real* from)
    {
        NodeLine line;
        for (int n = 0; n < pieces; ++n) line.part[n] = Lanes::load(from + n * piece);
        return line;
    }
    [[gnu::always_inline]] void store(Real* to) const
    {
        for (int n = 0; n < pieces; ++n) part[n].store(to + n * piece);
    }

    [[gnu::always_inline]] NodeLine& operator+=(const NodeLine& b)
    {
        for (int n = 0; n < pieces; ++n) part[n] += b.part[n];
        return *this;
    }
    [[gnu::always_inline]] NodeLine& operator-=(const NodeLine& b)
    {
        for (int n = 0; n < pieces; ++n) part[n] -= b.part[n];
        return *this;
    }
    [[gnu::always_inline]] NodeLine& operator*=(const NodeLine& b)
    {
        for (int n = 0; n < pieces; ++n) part[n] *= b.part[n];
        return *this;
    }
    [[gnu::always_inline]] friend NodeLine operator+(NodeLine a, const NodeLine& b) { return a += b; }
    [[gnu::always_inline]] friend NodeLine operator*(NodeLine a, const NodeLine& b) { return a *= b; }
    /// All lanes times the same number, which is in every lane of `b`.
    [[gnu::always_inline]] friend NodeLine operator*(Lanes b, NodeLine a)
    {
        for (Lanes& p : a.part) p *= b;
        return a;
    }
};

namespace detail
{
/// Half `A` (0 lower, 1 upper) of a, then half `B` of b.
template <int A, int B>
[[gnu::always_inline]] inline NodeLine join_halves(const NodeLine& a, const NodeLine& b)
{
    NodeLine line;
    if constexpr (NodeLine::pieces == 1) {
        line.part[0].v = [&]<int... I>(std::integer_sequence<int, I...>) __attribute__((always_inline))
        {
            return __builtin_shufflevector(a.part[0].v, b.part[0].v, (4 * A + I)..., (8 + 4 * B + I)...);
        }
        (std::make_integer_sequence<int, 4>{});
    } else {
        constexpr int half = NodeLine::pieces / 2;
        for (int n = 0; n < half; ++n) {
            line.part[n] = a.part[A * half + n];
            line.part[half + n] = b.part[B * half + n];
        }
    }
    return line;
}

/// Lower half of a, upper half of b.
[[gnu::always_inline]] inline NodeLine halves(const NodeLine& a, const NodeLine& b)
{
    return join_halves<0, 1>(a, b);
}
/// Lower halves of both, upper halves of both.
[[gnu::always_inline]] inline NodeLine lower_halves(const NodeLine& a, const NodeLine& b)
{
    return join_halves<0, 0>(a, b);
}
[[gnu::always_inline]] inline NodeLine upper_halves(const NodeLine& a, const NodeLine& b)
{
    return join_halves<1, 1>(a, b);
}
} // namespace detail
} // namespace transfer
