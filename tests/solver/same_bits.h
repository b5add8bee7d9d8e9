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

/// Particles in stored order, all columns but the ids.
inline void expect_same_particles(const particles::Particles& a, const particles::Particles& b)
{
    std::vector<const particles::Column*> columns;
    particles::Particles::for_each_real(a, [&](const auto&, const auto& column) { columns.push_back(&column); });
    std::size_t n = 0;
    particles::Particles::for_each_real(
        b, [&](const auto& name, const auto& column) { EXPECT_TRUE(same_bits(*columns[n++], column)) << name; });
    EXPECT_EQ(a.crack, b.crack);
    ASSERT_EQ(a.cracks.size(), b.cracks.size());
    for (std::size_t c = 0; c < a.cracks.size(); ++c) {
        EXPECT_EQ(a.cracks[c].damage, b.cracks[c].damage);
        EXPECT_EQ(a.cracks[c].normal, b.cracks[c].normal);
        EXPECT_EQ(a.cracks[c].opening, b.cracks[c].opening);
        EXPECT_EQ(a.cracks[c].onset_time, b.cracks[c].onset_time);
    }
}

inline void expect_same_loads(const std::vector<solver::LoadState>& a, const std::vector<solver::LoadState>& b)
{
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].reaction, b[i].reaction);
        EXPECT_EQ(a[i].impulse, b[i].impulse);
        EXPECT_EQ(a[i].spin, b[i].spin);
        EXPECT_EQ(a[i].external_work, b[i].external_work);
    }
}
} // namespace test
