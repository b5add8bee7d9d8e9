#include "app/template.h"

#include "app/forecast.h"
#include "io/case.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace
{
solver::Problem refined_block()
{
    solver::Problem problem;
    problem.grid.cell = 1;
    problem.grid.levels = 2;
    problem.materials.push_back({"steel", {7.81e-3, 195e3, 0.3}, {}, {}, true});
    // Wider than a slab of the counter, so that a slab boundary lies inside.
    problem.bodies.push_back({"block", geometry::box(Vec3(0, 0, 0), Vec3(20, 4, 4)), 0, Vec3::Zero()});
    problem.zones.push_back({"end", geometry::box(Vec3(6, -1, -1), Vec3(10, 5, 5)), 1, 0});
    problem.end.time = 1;
    return problem;
}

TEST(Template, is_a_valid_case)
{
    const support::Folder folder;
    std::ofstream(folder / "demo.toml") << app::case_template("demo");
    const io::Case read = io::read_case_with_warnings(folder / "demo.toml");
    EXPECT_EQ(read.problem.title, "demo");
    EXPECT_TRUE(read.warnings.empty());
}

TEST(Template, takes_any_name_as_title)
{
    const support::Folder folder;
    std::ofstream(folder / "demo.toml") << app::case_template("a \"b\" \\ c");
    EXPECT_EQ(io::read_case(folder / "demo.toml").title, "a \"b\" \\ c");
}

TEST(Forecast, counts_the_particles_of_a_block)
{
    const solver::Problem problem = refined_block();
    const app::Forecast forecast = app::forecast(problem);
    // Cells 6 to 9 along x, and 5 and 10, whose faces the closed zone touches only in its boundary, stay coarse.
    EXPECT_EQ(forecast.particles.at(1), 4U * 4 * 4 * 64);
    EXPECT_EQ(forecast.particles.at(0), 16U * 4 * 4 * 8);
    EXPECT_EQ(forecast.total_particles(), forecast.particles[0] + forecast.particles[1]);
    const Real wave = std::sqrt(problem.materials[0].elastic.wave_modulus() / 7.81e-3);
    EXPECT_NEAR(forecast.dt, 0.5 * 0.5 / wave, 1e-12);
    EXPECT_EQ(forecast.steps, std::ceil(1 / forecast.dt));
}

TEST(Forecast, estimates_particles_that_take_long_to_count)
{
    solver::Problem problem = refined_block();
    EXPECT_FALSE(app::count_particles(problem).estimated);
    problem.grid.cell = 0.01;
    const app::ParticleCount count = app::count_particles(problem);
    EXPECT_TRUE(count.estimated);
    EXPECT_NEAR(static_cast<Real>(count.particles.at(1)), 4 * 4 * 4 * 64e6, 0.07 * 4 * 4 * 4 * 64e6);
    EXPECT_NEAR(static_cast<Real>(count.particles.at(0)), 16 * 4 * 4 * 8e6, 0.07 * 16 * 4 * 4 * 8e6);
    EXPECT_GT(app::memory_of(count), 360 * static_cast<Real>(count.total_particles()));
}

TEST(Forecast, counts_the_bytes_of_grid_frames)
{
    solver::Problem problem = refined_block();
    EXPECT_EQ(app::forecast(problem).grid_bytes, 0);
    problem.output.grid.time = 0.25;
    problem.output.grid_fields = {"density", "velocity"};
    const app::Forecast forecast = app::forecast(problem);
    EXPECT_EQ(forecast.grid_frames, 4); // none at the beginning; the last one at the end
    // Fine cells, coarse cells, and the 4 x 4 x 4 coarse cells that the fine ones fill.
    const Real cells = 4 * 4 * 4 * 8 + 16 * 4 * 4 + 4 * 4 * 4;
    EXPECT_DOUBLE_EQ(forecast.grid_bytes, 4 * cells * (1 + 4 + 12));
}

TEST(Forecast, counts_one_more_frame_at_an_end_between_two)
{
    solver::Problem problem = refined_block();
    const auto frames = [&](Real every) {
        problem.output.particles.time = every;
        return app::forecast(problem).particle_frames;
    };
    EXPECT_EQ(frames(0.1), 10); // 1 / 0.1 as the machine divides
    EXPECT_EQ(frames(0.3), 4);
    EXPECT_EQ(frames(2), 1);
}

TEST(Forecast, map_shows_levels_and_voids)
{
    solver::Problem problem;
    problem.grid.cell = 1;
    problem.grid.levels = 2;
    problem.bodies.push_back({"bar",
                              geometry::subtract(geometry::box(Vec3(0, 0, 0), Vec3(8, 4, 1)),
                                                 {geometry::box(Vec3(0, 0, -1), Vec3(2, 2, 2))}),
                              0, Vec3::Zero()});
    problem.zones.push_back({"end", geometry::box(Vec3(6, -1, -1), Vec3(9, 5, 5)), 1, 0});
    EXPECT_EQ(app::level_map(problem, 78), "00000011\n..000011\n");
}
} // namespace
