/// Equality of whole states, to the bit.
#pragma once

#include "solver/state.h"

#include <gtest/gtest.h>

#include <cstring>

namespace test
{
template <class T, class Allocator>
bool same_bits(const std::vector<T, Allocator>& a, const std::vector<T, Allocator>& b)
{
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline std::vector<core::Crack> without_ids(std::vector<core::Crack> cracks)
{
    for (core::Crack& crack : cracks) crack.particle_id = 0;
    return cracks;
}

/// Particles in stored order, all columns but the ids and the levels: the same cells may be those of another level.
inline void expect_same_particles(const particles::Particles& a, const particles::Particles& b)
{
    std::vector<const particles::Column*> columns;
    particles::Particles::for_each_real(a, [&](const auto&, const auto& column) { columns.push_back(&column); });
    std::size_t n = 0;
    particles::Particles::for_each_real(
        b, [&](const auto& name, const auto& column) { EXPECT_TRUE(same_bits(*columns[n++], column)) << name; });
    EXPECT_EQ(a.crack, b.crack);
    EXPECT_EQ(a.material, b.material);
    EXPECT_EQ(a.body, b.body);
    EXPECT_EQ(a.away, b.away);
    EXPECT_TRUE(same_bits(without_ids(a.cracks), without_ids(b.cracks)));
}

inline void expect_same_levels(const particles::Particles& a, const particles::Particles& b)
{
    EXPECT_EQ(a.target_level, b.target_level);
    EXPECT_EQ(a.size_level, b.size_level);
}

inline void expect_same_loads(const std::vector<solver::LoadState>& a, const std::vector<solver::LoadState>& b)
{
    EXPECT_TRUE(same_bits(a, b));
}
} // namespace test
