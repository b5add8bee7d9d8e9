/// The SIMD type of the kernels: N lanes of T in GCC/clang vector extensions, with masks, tails and a transpose.
///
/// A kernel is written once over `Pack<T, N>`; the widest N of the compiled instruction set is `native_lanes`. Explicit
/// types are needed because auto-vectorised small blocks spill every temporary (docs/performance.md). A `Pack<T, 1>` is
/// not special: scalar code uses T itself, the overloads at the end make the same source compile for both.
#pragma once

#include "core/real.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#if defined(__AVX512F__) || defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace core
{
#if defined(__AVX512F__)
inline constexpr int simd_bytes = 64;
#elif defined(__AVX__)
inline constexpr int simd_bytes = 32;
#else
inline constexpr int simd_bytes = 16;
#endif

/// Lanes of T in one hardware vector of the instruction set this file is compiled for.
template <class T>
inline constexpr int native_lanes = simd_bytes / static_cast<int>(sizeof(T));

template <class T>
using LaneInteger = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;

/// The compiler's vector type. A template of its own, because g++ 12 loses the attribute on a member typedef that
/// the members of the same template name in their signatures.
template <class T, int N>
struct VectorOf
{
    typedef T type __attribute__((vector_size(static_cast<unsigned>(N) * sizeof(T))));
    typedef T unaligned __attribute__((vector_size(static_cast<unsigned>(N) * sizeof(T)), aligned(alignof(T))));
};

/// A truth value per lane: all bits set or none.
template <class T, int N>
struct Mask
{
    using Bits = typename VectorOf<LaneInteger<T>, N>::type;
    Bits v;
    bool operator[](int lane) const { return v[lane] != 0; }
    friend Mask operator&(Mask a, Mask b) { return {a.v & b.v}; }
    friend Mask operator|(Mask a, Mask b) { return {a.v | b.v}; }
    friend Mask operator!(Mask a) { return {~a.v}; }
};

template <class T, int N>
struct Pack
{
    using Lanes = typename VectorOf<T, N>::type;
    // Aligned like T, but still a vector of T: other than a memcpy it may not overwrite pointers, so the compiler need
    // not read the address of every column again after each store.
    using Unaligned = typename VectorOf<T, N>::unaligned;
    static constexpr int lanes = N;
    Lanes v;

    Pack() = default;
    constexpr Pack(T s) : v(s - Lanes{}) {}
    explicit constexpr Pack(int s) : v(static_cast<T>(s) - Lanes{}) {}
    /// Any other number type, so that T(0.5) means the same for T = double and for packs of float.
    template <class U>
    requires(std::is_arithmetic_v<U> && !std::is_same_v<U, T>) explicit constexpr Pack(U s) : Pack(static_cast<T>(s)) {}
    constexpr Pack(Lanes w) : v(w) {}

    T operator[](int lane) const { return v[lane]; }

    /// Read N consecutive values; no alignment needed.
    static Pack load(const T* from) { return {*reinterpret_cast<const Unaligned*>(from)}; }
    void store(T* to) const { *reinterpret_cast<Unaligned*>(to) = v; }

    friend Pack operator+(Pack a, Pack b) { return {a.v + b.v}; }
    friend Pack operator-(Pack a, Pack b) { return {a.v - b.v}; }
    friend Pack operator*(Pack a, Pack b) { return {a.v * b.v}; }
    friend Pack operator/(Pack a, Pack b) { return {a.v / b.v}; }
    friend Pack operator-(Pack a) { return {-a.v}; }
    Pack& operator+=(Pack b) { return v += b.v, *this; }
    Pack& operator-=(Pack b) { return v -= b.v, *this; }
    Pack& operator*=(Pack b) { return v *= b.v, *this; }
    friend Mask<T, N> operator<(Pack a, Pack b) { return {a.v < b.v}; }
    friend Mask<T, N> operator>(Pack a, Pack b) { return {a.v > b.v}; }
    friend Mask<T, N> operator<=(Pack a, Pack b) { return {a.v <= b.v}; }
    friend Mask<T, N> operator>=(Pack a, Pack b) { return {a.v >= b.v}; }
};

/// a where the mask is set, b elsewhere.
template <class T, int N>
Pack<T, N> select(Mask<T, N> mask, Pack<T, N> a, std::type_identity_t<Pack<T, N>> b)
{
    return {mask.v ? a.v : b.v};
}

template <class T, int N>
bool any(Mask<T, N> mask)
{
    for (int i = 0; i < N; ++i)
        if (mask.v[i] != 0) return true;
    return false;
}

#if defined(__AVX512F__)
inline bool any(Mask<double, 8> mask)
{
    return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(mask.v), reinterpret_cast<__m512i>(mask.v)) != 0;
}
inline bool any(Mask<float, 16> mask)
{
    return _mm512_test_epi32_mask(reinterpret_cast<__m512i>(mask.v), reinterpret_cast<__m512i>(mask.v)) != 0;
}
#elif defined(__AVX__)
inline bool any(Mask<double, 4> mask)
{
    return _mm256_movemask_pd(reinterpret_cast<__m256d>(mask.v)) != 0;
}
inline bool any(Mask<float, 8> mask)
{
    return _mm256_movemask_ps(reinterpret_cast<__m256>(mask.v)) != 0;
}
#elif defined(__SSE2__)
inline bool any(Mask<double, 2> mask)
{
    return _mm_movemask_pd(reinterpret_cast<__m128d>(mask.v)) != 0;
}
inline bool any(Mask<float, 4> mask)
{
    return _mm_movemask_ps(reinterpret_cast<__m128>(mask.v)) != 0;
}
#endif

/// Lane by lane to another number type.
template <class U, class T, int N>
Pack<U, N> convert(Pack<T, N> a)
{
    return {__builtin_convertvector(a.v, typename Pack<U, N>::Lanes)};
}

namespace detail
{
/// One round of a transpose: of every pair of vectors whose numbers differ in bit `Distance` only, swap the upper half
/// of one with the lower half of the other, halves of groups of 2 Distance lanes.
template <int Distance, class T, int N>
[[gnu::always_inline]] inline void swap_halves(Pack<T, N>& a, Pack<T, N>& b)
{
    [&]<int... I>(std::integer_sequence<int, I...>) __attribute__((always_inline))
    {
        const Pack<T, N> lower{__builtin_shufflevector(a.v, b.v, ((I & Distance) == 0 ? I : N + I - Distance)...)};
        const Pack<T, N> upper{__builtin_shufflevector(a.v, b.v, ((I & Distance) == 0 ? I + Distance : N + I)...)};
        a = lower;
        b = upper;
    }
    (std::make_integer_sequence<int, N>{});
}

template <int Distance, class T, int N, int M>
[[gnu::always_inline]] inline void transpose_from(Pack<T, N> (&r)[M])
{
    if constexpr (Distance < M) {
        for (int i = 0; i < M; ++i)
            if ((i & Distance) == 0) swap_halves<Distance>(r[i], r[i + Distance]);
        transpose_from<2 * Distance>(r);
    }
}
} // namespace detail

/// Rows become columns in every M x M block of M vectors (N = M: one block, N = 2 M: two side by side), in rounds of
/// pairwise shuffles. M is a power of two that divides N.
template <class T, int N, int M>
requires(N % M == 0 && (M & (M - 1)) == 0) [[gnu::always_inline]] inline void transpose(Pack<T, N> (&r)[M])
{
    detail::transpose_from<1>(r);
}

template <class T, int N>
Pack<T, N> sqrt(Pack<T, N> a)
{
#if defined(__AVX512F__)
    // The zero-masked forms: the plain ones of g++ 12 start from an undefined vector and warn.
    if constexpr (std::is_same_v<T, double> && N == 8) return {_mm512_maskz_sqrt_pd(0xff, a.v)};
    if constexpr (std::is_same_v<T, float> && N == 16) return {_mm512_maskz_sqrt_ps(0xffff, a.v)};
#endif
#if defined(__AVX__)
    if constexpr (std::is_same_v<T, double> && N == 4) return {_mm256_sqrt_pd(a.v)};
    if constexpr (std::is_same_v<T, float> && N == 8) return {_mm256_sqrt_ps(a.v)};
#endif
#if defined(__SSE2__)
    if constexpr (std::is_same_v<T, double> && N == 2) return {_mm_sqrt_pd(a.v)};
    if constexpr (std::is_same_v<T, float> && N == 4) return {_mm_sqrt_ps(a.v)};
#endif
    Pack<T, N> r;
    for (int i = 0; i < N; ++i) r.v[i] = std::sqrt(a.v[i]);
    return r;
}

template <class T, int N>
Pack<T, N> max(Pack<T, N> a, std::type_identity_t<Pack<T, N>> b)
{
    return {a.v > b.v ? a.v : b.v};
}

template <class T, int N>
Pack<T, N> min(Pack<T, N> a, std::type_identity_t<Pack<T, N>> b)
{
    return {a.v < b.v ? a.v : b.v};
}

/// Sum of the lanes, halves first: (0 + N/2), (1 + N/2 + 1), ... and so on down to one.
template <class T, int N>
T sum(Pack<T, N> a)
{
    if constexpr (N == 1) {
        return a.v[0];
    } else {
        return [&]<int... I>(std::integer_sequence<int, I...>)
        {
            const typename Pack<T, N / 2>::Lanes lower = __builtin_shufflevector(a.v, a.v, I...);
            const typename Pack<T, N / 2>::Lanes upper = __builtin_shufflevector(a.v, a.v, (N / 2 + I)...);
            return sum(Pack<T, N / 2>(lower + upper));
        }
        (std::make_integer_sequence<int, N / 2>{});
    }
}

/// Mask of the first `count` lanes.
template <class T, int N>
Mask<T, N> first_lanes(int count)
{
    typename Mask<T, N>::Bits index;
    for (int i = 0; i < N; ++i) index[i] = i;
    return {index < static_cast<LaneInteger<T>>(count)};
}

/// Read the first `count` lanes (count >= 1); the rest are zero.
template <class T, int N>
[[gnu::always_inline]] inline Pack<T, N> load_tail(const T* from, int count)
{
    if (count >= N) return Pack<T, N>::load(from);
#if defined(__AVX512F__)
    if constexpr (std::is_same_v<T, double> && N == 8)
        return {_mm512_maskz_loadu_pd(static_cast<__mmask8>((1u << count) - 1u), from)};
#endif
    Pack<T, N> p(T(0));
    std::memcpy(&p.v, from, sizeof(T) * static_cast<std::size_t>(count));
    return p;
}

/// Write the first `count` lanes.
template <class T, int N>
[[gnu::always_inline]] inline void store_tail(Pack<T, N> p, T* to, int count)
{
    if (count >= N) return p.store(to);
#if defined(__AVX512F__)
    if constexpr (std::is_same_v<T, double> && N == 8)
        return _mm512_mask_storeu_pd(to, static_cast<__mmask8>((1u << count) - 1u), p.v);
#endif
    std::memcpy(to, &p.v, sizeof(T) * static_cast<std::size_t>(count));
}

// The scalar versions of the same verbs, so that a kernel body compiles for T = double too.
inline Real select(bool mask, Real a, Real b)
{
    return mask ? a : b;
}
inline bool any(bool mask)
{
    return mask;
}
inline Real max(Real a, Real b)
{
    return a > b ? a : b;
}
inline Real min(Real a, Real b)
{
    return a < b ? a : b;
}
inline Real sqrt(Real a)
{
    return std::sqrt(a);
}
} // namespace core
