/// transfer/slot_slopes.h against the trilinear functions themselves.
#include "transfer/slot_slopes.h"

#include "tests/support/random.h"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <algorithm>

namespace
{
using transfer::Slopes;

using Corners = Real[8];
using Lanes = core::Pack<Real, 8>;

Vec3 slot_point(int slot)
{
    return Vec3::Constant(0.25) + 0.5 * Vec3(slot >> 2, slot >> 1 & 1, slot & 1);
}

/// Derivative along `axis` of the trilinear function of one corner.
Real slope_of(int corner, int axis, const Vec3& at)
{
    Real product = 1;
    for (int a = 0; a < 3; ++a) {
        const bool upper = corner >> (2 - a) & 1;
        product *= a == axis ? (upper ? 1 : -1) : upper ? at[a] : 1 - at[a];
    }
    return product;
}

Real slope_of_field(const Corners& corner, int axis, const Vec3& at)
{
    Real sum = 0;
    for (int c = 0; c < 8; ++c) sum += corner[c] * slope_of(c, axis, at);
    return sum;
}

void fill(support::Random& random, Corners& corner)
{
    for (Real& value : corner) value = random.between(-1, 1);
}
} // namespace

TEST(SlotSlopes, are_the_gradient_of_the_trilinear_field)
{
    support::Random random(1);
    for (int n = 0; n < 100; ++n) {
        Corners corner;
        fill(random, corner);
        const Slopes<Real> slopes = transfer::slopes_at_slots(corner);
        for (int slot = 0; slot < transfer::slots; ++slot)
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_NEAR(slopes.along[axis][transfer::slope_place(axis, slot)],
                            slope_of_field(corner, axis, slot_point(slot)), 1e-15);
    }
}

TEST(SlotSlopes, slots_that_share_a_slope_differ_only_along_its_axis)
{
    for (int axis = 0; axis < 3; ++axis)
        for (int slot = 0; slot < transfer::slots; ++slot) {
            const int other = slot ^ 4 >> axis; // the slot on the other side along the axis
            EXPECT_EQ(transfer::slope_place(axis, slot), transfer::slope_place(axis, other));
            EXPECT_LT(transfer::slope_place(axis, slot), 4);
        }
}

TEST(SlotSlopes, vanish_to_the_bit_in_a_constant_field)
{
    support::Random random(2);
    for (int n = 0; n < 100; ++n) {
        Corners corner;
        std::fill(std::begin(corner), std::end(corner), random.between(-1e9, 1e9));
        for (const auto& axis : transfer::slopes_at_slots(corner).along)
            for (const Real slope : axis) EXPECT_EQ(slope, 0);
    }
}

TEST(SlotSlopes, of_lanes_are_those_of_each_lane)
{
    support::Random random(3);
    Corners corner[Lanes::lanes];
    Lanes lanes[8];
    for (int i = 0; i < Lanes::lanes; ++i) {
        fill(random, corner[i]);
        for (int c = 0; c < 8; ++c) lanes[c].v[i] = corner[i][c];
    }
    const Slopes<Lanes> all = transfer::slopes_at_slots(lanes);
    for (int i = 0; i < Lanes::lanes; ++i) {
        const Slopes<Real> one = transfer::slopes_at_slots(corner[i]);
        for (int axis = 0; axis < 3; ++axis)
            for (int place = 0; place < 4; ++place)
                EXPECT_NEAR(all.along[axis][place][i], one.along[axis][place], 1e-15);
    }
}

// Entry by entry: both operators are linear, so unit vectors show them whole.
TEST(SlotSlopes, corners_get_the_adjoint)
{
    for (int axis = 0; axis < 3; ++axis)
        for (int place = 0; place < 4; ++place) {
            Slopes<Real> flux{};
            flux.along[axis][place] = 1;
            Corners from_flux;
            transfer::slopes_to_corners(flux, from_flux);
            for (int c = 0; c < 8; ++c) {
                Corners unit{};
                unit[c] = 1;
                EXPECT_NEAR(from_flux[c], transfer::slopes_at_slots(unit).along[axis][place], 1e-14);
            }
        }
}

TEST(SlotSlopes, pairing_with_any_flux_is_that_of_the_corners)
{
    support::Random random(4);
    for (int n = 0; n < 100; ++n) {
        Corners corner, force;
        fill(random, corner);
        Slopes<Real> flux;
        for (auto& axis : flux.along)
            for (Real& value : axis) value = random.between(-1, 1);
        transfer::slopes_to_corners(flux, force);
        const Slopes<Real> slopes = transfer::slopes_at_slots(corner);
        Real inside = 0, outside = 0, total = 0;
        for (int axis = 0; axis < 3; ++axis)
            for (int place = 0; place < 4; ++place) inside += flux.along[axis][place] * slopes.along[axis][place];
        for (int c = 0; c < 8; ++c) {
            outside += force[c] * corner[c];
            total += force[c];
        }
        EXPECT_NEAR(inside, outside, 1e-14);
        EXPECT_NEAR(total, 0, 1e-14); // no flux pushes the cell as a whole
    }
}

TEST(SlotSlopes, deformation_is_one_plus_the_gradient_of_the_displacement)
{
    support::Random random(5);
    const Real spacing = 0.4;
    Corners corner[3];
    Slopes<Real> slopes[3];
    for (int a = 0; a < 3; ++a) {
        fill(random, corner[a]);
        slopes[a] = transfer::slopes_at_slots(corner[a]);
    }
    for (int slot = 0; slot < transfer::slots; ++slot) {
        const core::Mat<Real> f = transfer::deformation_at(slopes, slot, 1 / spacing);
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b)
                EXPECT_NEAR(f(a, b), (a == b ? 1 : 0) + slope_of_field(corner[a], b, slot_point(slot)) / spacing,
                            1e-14);
    }
}
