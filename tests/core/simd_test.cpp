/// core/simd.h: what the kernels ask of it, lane by lane against plain loops.
#include "core/simd.h"

#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{
using core::Mask;
using core::Pack;

template <class P>
struct Traits;
template <class T, int N>
struct Traits<Pack<T, N>>
{
    using Number = T;
    static constexpr int lanes = N;
};

template <class P>
class Simd : public testing::Test
{
protected:
    using Number = typename Traits<P>::Number;
    static constexpr int width = Traits<P>::lanes;

    P random()
    {
        P p;
        for (int i = 0; i < width; ++i) p.v[i] = static_cast<Number>(random_.between(-1, 1));
        return p;
    }
    static Mask<Number, width> only(int lane)
    {
        Mask<Number, width> mask{};
        mask.v[lane] = -1;
        return mask;
    }

private:
    support::Random random_{7};
};

using Packs = testing::Types<Pack<double, 8>, Pack<float, 16>, Pack<double, 4>, Pack<float, 8>, Pack<double, 2>>;
TYPED_TEST_SUITE(Simd, Packs);

/// M vectors of type P, with blocks of M x M.
template <class P, int M>
struct Square
{
    using Row = P;
    static constexpr int side = M;
};

template <class S>
class SimdRows : public Simd<typename S::Row>
{};
using Squares = testing::Types<Square<Pack<double, 8>, 8>, Square<Pack<float, 16>, 8>, Square<Pack<float, 8>, 8>,
                               Square<Pack<double, 4>, 4>, Square<Pack<float, 8>, 4>, Square<Pack<float, 4>, 4>,
                               Square<Pack<double, 2>, 2>>;
TYPED_TEST_SUITE(SimdRows, Squares);
} // namespace

// Entry (i, j) of every block goes to (j, i) of the same block.
TYPED_TEST(SimdRows, transpose_exchanges_rows_and_columns_of_every_block)
{
    using Row = typename TypeParam::Row;
    using T = typename Traits<Row>::Number;
    constexpr int side = TypeParam::side;
    Row rows[side];
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < Row::lanes; ++j) rows[i].v[j] = static_cast<T>(100 * i + j);
    core::transpose(rows);
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < Row::lanes; ++j)
            EXPECT_EQ(rows[i][j], static_cast<T>(100 * (j % side) + j / side * side + i)) << i << ' ' << j;
}

TYPED_TEST(SimdRows, transposing_twice_changes_no_bit)
{
    using Row = typename TypeParam::Row;
    using T = typename Traits<Row>::Number;
    Row rows[TypeParam::side], twice[TypeParam::side];
    for (Row& row : rows) row = this->random();
    rows[0].v[1] = -T(0);
    rows[1].v[0] = std::numeric_limits<T>::quiet_NaN();
    std::copy(std::begin(rows), std::end(rows), std::begin(twice));
    core::transpose(twice);
    core::transpose(twice);
    EXPECT_EQ(std::memcmp(rows, twice, sizeof(rows)), 0);
}

TYPED_TEST(Simd, convert_is_the_conversion_of_every_lane)
{
    using T = typename Traits<TypeParam>::Number;
    using Other = std::conditional_t<sizeof(T) == 8, float, double>;
    const TypeParam a = this->random() * TypeParam(T(1e3)) / TypeParam(T(7));
    const auto b = core::convert<Other>(a);
    const auto back = core::convert<T>(b);
    for (int i = 0; i < TypeParam::lanes; ++i) {
        EXPECT_EQ(b[i], static_cast<Other>(a[i]));
        EXPECT_EQ(back[i], static_cast<T>(static_cast<Other>(a[i])));
    }
}

TYPED_TEST(Simd, any_sees_a_single_lane)
{
    EXPECT_FALSE(core::any(TypeParam(0) > TypeParam(0)));
    EXPECT_TRUE(core::any(TypeParam(1) > TypeParam(0)));
    for (int lane = 0; lane < TypeParam::lanes; ++lane) EXPECT_TRUE(core::any(this->only(lane))) << lane;
}

TYPED_TEST(Simd, select_takes_each_lane_from_its_side_and_nothing_of_the_other)
{
    using T = typename Traits<TypeParam>::Number;
    const TypeParam a = this->random(), nan(std::numeric_limits<T>::quiet_NaN());
    for (int lane = 0; lane < TypeParam::lanes; ++lane) {
        const TypeParam taken = core::select(this->only(lane), a, nan), left = core::select(this->only(lane), nan, a);
        for (int i = 0; i < TypeParam::lanes; ++i) {
            EXPECT_EQ(std::isnan(taken[i]), i != lane);
            EXPECT_EQ(std::isnan(left[i]), i == lane);
        }
        EXPECT_EQ(taken[lane], a[lane]);
    }
}

TYPED_TEST(Simd, comparisons_and_masks_are_those_of_the_lanes)
{
    for (int n = 0; n < 20; ++n) {
        const TypeParam a = this->random(), b = this->random();
        const auto less = a<b, large = a> TypeParam(0.5);
        for (int i = 0; i < TypeParam::lanes; ++i) {
            EXPECT_EQ(less[i], a[i] < b[i]);
            EXPECT_EQ((a >= b)[i], !(a[i] < b[i]));
            EXPECT_EQ((less & large)[i], less[i] && large[i]);
            EXPECT_EQ((less | large)[i], less[i] || large[i]);
            EXPECT_EQ((!less)[i], !less[i]);
            EXPECT_EQ(core::max(a, b)[i], std::max(a[i], b[i]));
            EXPECT_EQ(core::min(a, b)[i], std::min(a[i], b[i]));
            EXPECT_EQ(core::sqrt(a * a)[i], std::sqrt((a * a)[i]));
        }
    }
}

TYPED_TEST(Simd, sum_adds_halves_first)
{
    using T = typename Traits<TypeParam>::Number;
    const TypeParam a = this->random();
    T part[TypeParam::lanes];
    a.store(part);
    for (int half = TypeParam::lanes / 2; half > 0; half /= 2)
        for (int i = 0; i < half; ++i) part[i] += part[i + half];
    EXPECT_EQ(core::sum(a), part[0]);
}

TYPED_TEST(Simd, tails_touch_only_their_lanes)
{
    using T = typename Traits<TypeParam>::Number;
    constexpr int lanes = TypeParam::lanes;
    T numbers[lanes];
    for (int i = 0; i < lanes; ++i) numbers[i] = static_cast<T>(i + 1);
    for (int count = 1; count <= lanes; ++count) {
        const auto head = core::load_tail<T, lanes>(numbers, count);
        const auto mask = core::first_lanes<T, lanes>(count);
        T written[lanes] = {};
        core::store_tail(TypeParam(T(5)), written, count);
        for (int i = 0; i < lanes; ++i) {
            EXPECT_EQ(head[i], i < count ? numbers[i] : T(0));
            EXPECT_EQ(mask[i], i < count);
            EXPECT_EQ(written[i], i < count ? T(5) : T(0));
        }
    }
}
