// Half a body beside a symmetry plane is half of the whole one.
#include "tests/support/runs.h"

#include <gtest/gtest.h>

using support::Job;

namespace
{
/// Bar with a hole about x = 0, where the stress is steep and cracks begin; onset by the mean over a ball.
solver::Problem holed_bar(bool whole)
{
    material::Material metal = support::breakable();
    metal.decohesion->nonlocal_radius = 0.6;
    solver::Problem problem = support::bar(metal, 4, 0.02);
    problem.grid.cell = 0.25;
    problem.numerics.transfer = solver::Transfer::nodal;
    problem.bodies[0].shape = geometry::subtract(geometry::box({whole ? -2. : 0., 0, 0}, {2, 4, 1}),
                                                 {geometry::cylinder({0, 2, -1}, {0, 2, 2}, 0.5)});
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
    const std::vector<Real> whole = onsets(holed_bar(true), 600), half = onsets(holed_bar(false), 600);
    ASSERT_GT(whole.size(), 20U);
    ASSERT_EQ(whole.size(), half.size());
    for (std::size_t n = 0; n < whole.size(); ++n) EXPECT_NEAR(whole[n], half[n], 1e-9);
}
