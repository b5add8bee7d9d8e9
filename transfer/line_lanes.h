/// How node lines, one per particle or cell, become lanes and back.
#pragma once

#include "core/simd.h"

namespace transfer
{
/// Numbers of a line of eight that are transposed at once, for vectors of N lanes.
template <int N>
inline constexpr int line_piece = N < 8 ? N : 8;

namespace detail
{
/// Two rows of eight as one vector of sixteen.
[[gnu::always_inline]] inline core::Pack<float, 16> joined(const core::Pack<Real, 8>& lower,
                                                           const core::Pack<Real, 8>& upper)
{
    const auto a = core::convert<float>(lower), b = core::convert<float>(upper);
    return {__builtin_shufflevector(a.v, b.v, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)};
}
} // namespace detail

/// Make N lines into eight vectors of N lanes; `piece(i, place)` are the `line_piece<N>` numbers of line i from `place`
/// on.
template <class T, int N, class Piece>
[[gnu::always_inline]] inline void lines_to_lanes(const Piece& piece, core::Pack<T, N> (&out)[8])
{
    constexpr int size = line_piece<N>;
    for (int place = 0; place < 8; place += size) {
        core::Pack<T, N> square[size];
        for (int i = 0; i < size; ++i) {
            if constexpr (N == 16)
                square[i] = detail::joined(piece(i, place), piece(i + 8, place));
            else
                square[i] = core::convert<T>(piece(i, place));
        }
        core::transpose(square);
        for (int i = 0; i < size; ++i) out[place + i] = square[i];
    }
}

/// The way back: `take(i, place, piece)` for every line i.
template <int N, class Take>
[[gnu::always_inline]] inline void lanes_to_lines(const core::Pack<Real, N> (&in)[8], const Take& take)
{
    constexpr int size = line_piece<N>;
    for (int place = 0; place < 8; place += size) {
        core::Pack<Real, N> square[size];
        for (int i = 0; i < size; ++i) square[i] = in[place + i];
        core::transpose(square);
        for (int i = 0; i < size; ++i) take(i, place, square[i]);
    }
}
} // namespace transfer
