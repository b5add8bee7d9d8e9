// Half a body beside a symmetry plane is half of the whole one.
#include "tests/support/runs.h"

#include <gtest/gtest.h>

using support::Job;

namespace
{
/// Bar with round notches in its sides, torn between them, across the plane x = 0; onset by the mean over a ball.
solver::Problem notched_bar(bool whole)
{
    material::Material metal = support::breakable();
    metal.decohesion->nonlocal_radius = 0.6;
    solver::Problem problem = support::bar(metal, 1, 0.02);
    problem.grid.cell = 0.25;
    problem.numerics.transfer = solver::Transfer::nodal;
    const auto notch = [](Real x) { return geometry::cylinder({x, 2, -1}, {x, 2, 2}, 1.2); };
    problem.bodies[0].shape =
        geometry::subtract(geometry::box({whole ? -2. : 0., 0, 0}, {2, 4, 1}), {notch(-2), notch(2)});
    if (!whole) problem.symmetry = {{0, 0}};
    return problem;
}

/// Times of onset of the particles at x > 0, in order.
std::vector<Real> onsets(const solver::Problem& problem, int steps)
{
    Job run = support::started(problem);
    support::advance(steps, run);
    const particles::Particles particles = support::particles_of(run);
    std::vector<Real> times;
    for (std::size_t p = 0; p < particles.size(); ++p)
        if (particles.crack[p] >= 0 && particles.rest_position[0][p] > 0)
            times.push_back(particles.cracks[static_cast<std::size_t>(particles.crack[p])].onset_time);
    std::sort(times.begin(), times.end());
    return times;
}
} // namespace

TEST(Symmetry, balls_see_the_image_beyond_the_plane)
{
    const std::vector<Real> whole = onsets(notched_bar(true), 1000), half = onsets(notched_bar(false), 1000);
    ASSERT_GT(whole.size(), 20U);
    ASSERT_EQ(whole.size(), half.size());
    for (std::size_t n = 0; n < whole.size(); ++n) EXPECT_NEAR(whole[n], half[n], 1e-9);
}
