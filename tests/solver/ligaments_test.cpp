/// solver/ligaments.h and measures.h on synthetic plates: two holes and an edge, cracks put in by hand.
#include "solver/ligaments.h"

#include "solver/ligament_events.h"
#include "solver/measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace solver
{
namespace
{
constexpr Real h = 0.25; // mm, finest spacing

/// A plate 8 x 4 x 1 with holes A at (1, 2) and D at (5, 2), radius 0.5, and its right edge E.
Problem plate()
{
    Problem problem;
    problem.grid.cell = 2 * h;
    problem.grid.levels = 2;
    const auto hole = [](Real x) { return geometry::cylinder({x, 2, -1}, {x, 2, 2}, 0.5); };
    problem.features = {{"A", hole(1), {1, 2, 0.5}},
                        {"D", hole(5), {5, 2, 0.5}},
                        {"E", geometry::half_space({8, 0, 0}, {-1, 0, 0}), {8, 2, 0.5}}};
    problem.ligaments = {{"A", "D", {{{1, 1}, {5, 1}, {5, 3}, {1, 3}}}, 2},
                         {"D", "E", {{{5, 1}, {8, 1}, {8, 3}, {5, 3}}}, 2}};
    problem.start_features = {"A"};
    problem.force_upper = "top";
    problem.force_lower = "bottom";
    return problem;
}

/// Two particles per cell and axis of the finest level, none in the holes.
particles::Particles particles_of(const Problem& problem, bool half_thickness_first = false)
{
    particles::Particles particles;
    const Real s = h / 2;
    for (int k = 0; k < 8; ++k)
        for (int i = 0; i < 64; ++i)
            for (int j = 0; j < 32; ++j) {
                const Vec3 x((i + 0.5) * s, (j + 0.5) * s, (half_thickness_first ? 7 - k + 0.5 : k + 0.5) * s);
                if (problem.features[0].shape.contains(x) || problem.features[1].shape.contains(x)) continue;
                for (std::size_t a = 0; a < 3; ++a) particles.rest_position[a].push_back(x[static_cast<int>(a)]);
                particles.rest_volume.push_back(s * s * s);
                particles.mass.push_back(1);
                particles.crack.push_back(-1);
            }
    return particles;
}

/// Give the damage to every particle for which `chosen(x)` holds.
template <class Choice>
void crack(particles::Particles& particles, Real damage, const Choice& chosen)
{
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const Vec3 x(particles.rest_position[0][p], particles.rest_position[1][p], particles.rest_position[2][p]);
        if (!chosen(x)) continue;
        if (particles.crack[p] < 0) {
            particles.crack[p] = static_cast<std::int32_t>(particles.cracks.size());
            particles.cracks.emplace_back();
        }
        particles.cracks[static_cast<std::size_t>(particles.crack[p])].damage = damage;
    }
}

/// A strip one cell high at y in [2, 2.25).
auto strip(Real from, Real to)
{
    return [=](const Vec3& x) { return x[0] > from && x[0] < to && x[1] > 2 && x[1] < 2 + h; };
}

LigamentMap map_of(const Problem& problem, const particles::Particles& particles)
{
    LigamentMap map = ligament_map(problem);
    weigh_columns(particles, map);
    return map;
}
} // namespace

TEST(Ligaments, nothing_happens_without_damage)
{
    const Problem problem = plate();
    std::vector<LigamentState> states;
    update_ligaments(map_of(problem, particles_of(problem)), particles_of(problem), {1, 2, 3}, states);
    ASSERT_EQ(states.size(), 2u);
    for (const LigamentState& state : states) {
        EXPECT_LT(state.onset_time, 0);
        EXPECT_LT(state.first_time, 0);
        EXPECT_LT(state.through_time, 0);
        EXPECT_EQ(state.front, 0);
    }
}

TEST(Ligaments, events_come_one_after_the_other_and_are_noted_once)
{
    const Problem problem = plate();
    const LigamentMap map = map_of(problem, particles_of(problem));
    particles::Particles particles = particles_of(problem);
    std::vector<LigamentState> states;

    crack(particles, 0.5, strip(1.5, 2));
    update_ligaments(map, particles, {1, 100, 0.1}, states);
    EXPECT_EQ(states[0].onset_time, 1);
    EXPECT_LT(states[0].first_time, 0);

    crack(particles, 1, [](const Vec3& x) { return strip(1.5, 2)(x) && x[2] < 0.8; }); // not through the thickness
    update_ligaments(map, particles, {2, 110, 0.2}, states);
    EXPECT_LT(states[0].first_time, 0);

    crack(particles, 1, strip(1.5, 2));
    update_ligaments(map, particles, {3, 120, 0.3}, states);
    EXPECT_EQ(states[0].first_time, 3);
    EXPECT_EQ(states[0].first_force, 120);
    EXPECT_EQ(states[0].first_cod, 0.3);
    EXPECT_LT(states[0].through_time, 0);
    EXPECT_NEAR(states[0].front, 2.0 / 16, 1e-12); // 2 of the stations; cells on the hole's circle have material too

    crack(particles, 1, strip(1.5, 4.5));
    update_ligaments(map, particles, {4, 90, 0.4}, states);
    EXPECT_EQ(states[0].through_time, 4);
    EXPECT_EQ(states[0].through_force, 90);
    EXPECT_EQ(states[0].onset_time, 1);
    EXPECT_EQ(states[0].first_time, 3);
    EXPECT_NEAR(states[0].front, 12.0 / 16, 1e-12);

    update_ligaments(map, particles, {5, 80, 0.5}, states);
    EXPECT_EQ(states[0].through_time, 4);
    EXPECT_LT(states[1].onset_time, 0); // the other ligament saw nothing
}

// Every event once, a front whenever it passes a multiple of 5 %, whatever happens within one look.
TEST(Ligaments, the_log_has_every_event_once)
{
    const Problem problem = plate();
    const LigamentMap map = map_of(problem, particles_of(problem));
    particles::Particles particles = particles_of(problem);
    std::vector<LigamentState> states;
    std::vector<LigamentEvent> events;
    const auto look = [&](std::int64_t step) {
        const Observation now{0.1 * static_cast<Real>(step), 100 - static_cast<Real>(step), 0.01};
        const std::vector<LigamentState> before = states;
        update_ligaments(map, particles, now, states);
        log_events(before, states, step, now, events);
    };
    look(1);
    EXPECT_TRUE(events.empty());
    crack(particles, 0.5, strip(1.5, 2));
    look(2);
    look(3);
    crack(particles, 1, strip(1.5, 2)); // 2 of 16 stations: 0.125
    look(4);
    crack(particles, 1, strip(1.5, 2.25)); // 0.1875
    look(5);
    crack(particles, 1, strip(2.25, 2.3)); // no further column
    look(6);
    crack(particles, 1, strip(1.5, 4.5));
    crack(particles, 1, strip(5.5, 8)); // the other one at once
    look(7);
    look(8);
    std::string text;
    for (const LigamentEvent& e : events)
        text +=
            std::to_string(e.step) + " " + std::to_string(e.ligament) + " " + std::string(event_name(e.kind)) + "; ";
    EXPECT_EQ(text, "2 0 onset; 4 0 first; 4 0 front; 5 0 front; 7 0 front; 7 0 through; "
                    "7 1 onset; 7 1 first; 7 1 front; 7 1 through; ");
    EXPECT_EQ(events[1].force, 96);
    EXPECT_EQ(events[1].cod, 0.01);
    EXPECT_NEAR(events[1].front, 0.125, 1e-12);
}

TEST(Ligaments, one_intact_tenth_is_allowed_more_is_not)
{
    const Problem problem = plate();
    const LigamentMap map = map_of(problem, particles_of(problem));
    for (const int intact_per_column : {3, 4}) { // of 32 particles
        particles::Particles particles = particles_of(problem);
        crack(particles, 1, strip(2, 2 + h));
        int left = intact_per_column;
        for (auto& crack : particles.cracks)
            if (left-- > 0) crack.damage = 0.99;
        std::vector<LigamentState> states;
        update_ligaments(map, particles, {1, 0, 0}, states);
        EXPECT_EQ(states[0].first_time >= 0, intact_per_column == 3);
    }
}

TEST(Ligaments, a_gap_separates_and_a_corner_joins)
{
    const Problem problem = plate();
    const LigamentMap map = map_of(problem, particles_of(problem));
    const auto through = [&](const auto& second) {
        particles::Particles particles = particles_of(problem);
        crack(particles, 1, strip(1.5, 3));
        crack(particles, 1, second);
        std::vector<LigamentState> states;
        update_ligaments(map, particles, {1, 0, 0}, states);
        return states[0].through_time >= 0;
    };
    EXPECT_FALSE(through(strip(3 + h, 4.5)));
    EXPECT_TRUE(through(strip(3, 4.5)));
    EXPECT_TRUE(through([](const Vec3& x) { return strip(3, 4.5)(x + Vec3(0, h, 0)); }));      // one row lower
    EXPECT_FALSE(through([](const Vec3& x) { return strip(3, 4.5)(x + Vec3(0, 2 * h, 0)); })); // two rows lower
}

TEST(Ligaments, a_slanted_crack_separates_if_it_is_through_in_nine_tenths_of_the_layers)
{
    const Problem problem = plate();
    const LigamentMap map = map_of(problem, particles_of(problem));
    for (const bool last_layer : {false, true}) {
        particles::Particles particles = particles_of(problem);
        const auto slanted = [](const Vec3& x) { return strip(1, 5)(x - Vec3(0, h * std::floor(x[2] / h) - h, 0)); };
        crack(particles, 1, [&](const Vec3& x) { return slanted(x) && (last_layer || x[2] < 1 - h); });
        std::vector<LigamentState> states;
        update_ligaments(map, particles, {1, 0, 0}, states);
        EXPECT_EQ(states[0].through_time >= 0, last_layer);
        EXPECT_EQ(states[0].first_time >= 0, last_layer); // paths are sorted by it
        EXPECT_EQ(states[0].front, 0);                    // no column is whole
    }
}

TEST(Ligaments, a_corridor_without_metal_never_breaks)
{
    Problem problem = plate();
    problem.ligaments[1].corridor = {{9, 1}, {10, 1}, {10, 3}, {9, 3}};
    particles::Particles particles = particles_of(problem);
    crack(particles, 1, strip(1, 5));
    std::vector<LigamentState> states;
    update_ligaments(map_of(problem, particles), particles, {1, 0, 0}, states);
    EXPECT_GE(states[0].through_time, 0);
    EXPECT_LT(states[1].onset_time, 0);
}

TEST(Ligaments, a_crack_outside_of_the_corridor_does_not_count)
{
    const Problem problem = plate();
    particles::Particles particles = particles_of(problem);
    crack(particles, 1, [](const Vec3& x) { return x[1] > 3 + h; });
    std::vector<LigamentState> states;
    update_ligaments(map_of(problem, particles), particles, {1, 0, 0}, states);
    EXPECT_LT(states[0].onset_time, 0);
}

TEST(Ligaments, the_corridor_is_the_polygon_and_not_its_box)
{
    Problem problem = plate();
    problem.ligaments[0].corridor = {{1, 1}, {5, 1}, {5, 3}}; // the triangle below the diagonal
    const LigamentMap map = map_of(problem, particles_of(problem));
    for (const bool below : {false, true}) {
        particles::Particles particles = particles_of(problem);
        crack(particles, 1, [&](const Vec3& x) {
            const Real diagonal = 1 + (x[0] - 1) / 2;
            return x[0] > 2 && x[0] < 4 && x[1] > 1 && x[1] < 3 && (below ? x[1] < diagonal - h : x[1] > diagonal + h);
        });
        std::vector<LigamentState> states;
        update_ligaments(map, particles, {1, 0, 0}, states);
        EXPECT_EQ(states[0].onset_time >= 0, below);
    }
}

TEST(Ligaments, a_crack_must_reach_both_features)
{
    const Problem problem = plate();
    const LigamentMap map = map_of(problem, particles_of(problem));
    for (const Real start : {1.5, 1.75, 2.0, 2.25}) { // 0.6, 1.54, 2.5 and 3.5 columns away from A
        particles::Particles particles = particles_of(problem);
        crack(particles, 1, strip(start, 4.5));
        std::vector<LigamentState> states;
        update_ligaments(map, particles, {1, 0, 0}, states);
        EXPECT_EQ(states[0].through_time >= 0, start == 1.5) << start;
    }
}

TEST(Ligaments, the_order_of_particles_does_not_matter)
{
    const Problem problem = plate();
    const LigamentMap map = map_of(problem, particles_of(problem));
    std::array<LigamentState, 2> result;
    for (const bool reversed : {false, true}) {
        particles::Particles particles = particles_of(problem, reversed);
        crack(particles, 1, strip(1.5, 3));
        std::vector<LigamentState> states;
        update_ligaments(map, particles, {1, 0, 0}, states);
        result[reversed] = states[0];
    }
    EXPECT_EQ(result[0].front, result[1].front);
    EXPECT_EQ(result[0].first_time, result[1].first_time);
}

TEST(Ligaments, thickness_may_be_any_axis)
{
    // The plate turned so that its thickness is x: (x, y, z) -> (z, x, y); the corridor's axes are then y, z.
    Problem problem = plate();
    const auto hole = [](Real y) { return geometry::cylinder({-1, y, 2}, {2, y, 2}, 0.5); };
    problem.features[0] = {"A", hole(1), {0.5, 1, 2}};
    problem.features[1] = {"D", hole(5), {0.5, 5, 2}};
    problem.features[2] = {"E", geometry::half_space({0, 8, 0}, {0, -1, 0}), {0.5, 8, 2}};
    for (Ligament& ligament : problem.ligaments) ligament.through = 0;
    particles::Particles particles = particles_of(plate());
    crack(particles, 1, strip(1.5, 4.5));
    std::rotate(particles.rest_position.begin(), particles.rest_position.begin() + 2, particles.rest_position.end());
    std::vector<LigamentState> states;
    update_ligaments(map_of(problem, particles), particles, {1, 0, 0}, states);
    EXPECT_EQ(states[0].through_time, 1);
    EXPECT_NEAR(states[0].front, 12.0 / 16, 1e-12);
}

namespace
{
/// SNL-like features: A notch, C and D holes, E edge.
const std::vector<Ligament> challenge{{"A", "D", {}, 2}, {"C", "D", {}, 2}, {"A", "C", {}, 2}, {"C", "E", {}, 2}};

std::vector<LigamentState> through_at(const std::vector<Real>& times)
{
    std::vector<LigamentState> states(times.size());
    for (std::size_t i = 0; i < times.size(); ++i) states[i].through_time = times[i];
    return states;
}
} // namespace

TEST(CrackPath, follows_the_earliest_separation)
{
    EXPECT_EQ(path_name(crack_path(challenge, through_at({1, 2, -1, 3}), {"A"})), "A-D-C-E");
    EXPECT_EQ(path_name(crack_path(challenge, through_at({-1, -1, 1, 2}), {"A"})), "A-C-E");
    EXPECT_EQ(path_name(crack_path(challenge, through_at({2, -1, 1, 3}), {"A"})), "A-C-E");
    EXPECT_EQ(path_name(crack_path(challenge, through_at({1, 2, 5, 3}), {"A"})), "A-D-C-E");
}

TEST(CrackPath, may_run_in_either_direction_and_stops_where_nothing_separated)
{
    EXPECT_EQ(path_name(crack_path(challenge, through_at({1, 2, -1, -1}), {"A"})), "A-D-C");
    EXPECT_EQ(path_name(crack_path(challenge, through_at({-1, -1, -1, 1}), {"E"})), "E-C");
    EXPECT_EQ(path_name(crack_path(challenge, through_at({-1, 2, -1, 3}), {"A"})), "");
    EXPECT_EQ(path_name(crack_path(challenge, through_at({3, -1, -1, 1}), {"A", "E"})), "E-C");
}

TEST(CrackPath, never_returns_to_a_feature)
{
    EXPECT_EQ(path_name(crack_path(challenge, through_at({1, 2, 3, -1}), {"A"})), "A-D-C");
}

TEST(Measures, take_the_mean_force_of_the_opening_before_a_crack)
{
    Problem problem = plate();
    problem.ligaments = challenge;
    problem.mean_over = 0.2;
    std::vector<HistoryLine> history(7);
    const std::array<Real, 7> cod{2.0, 2.3, 2.31, 2.4, 2.5, 2.55, 2.45}, force{1, 2, 30, 60, 90, 500, 900};
    for (std::size_t i = 0; i < history.size(); ++i) {
        history[i].time = static_cast<Real>(i);
        history[i].cod = cod[i];
        history[i].force_upper = force[i] - 5;
        history[i].force_lower = force[i] + 5;
    }
    std::vector<LigamentState> ligaments = through_at({4, -1, -1, -1});
    ligaments[0].first_time = 4;
    ligaments[0].first_cod = 2.5;
    const Measures result = measures(problem, history, ligaments);
    const auto found = std::find_if(result.numbers.begin(), result.numbers.end(),
                                    [](const Measure& measure) { return measure.name == "c1_mean_N"; });
    ASSERT_NE(found, result.numbers.end());
    EXPECT_NEAR(*found->value, 60, 1e-12);
    EXPECT_EQ(published_name("c1_mean_N"), "c1_force_N");
    EXPECT_EQ(published_name("c1_cod_mm"), "c1_cod_mm");
}

TEST(Measures, are_read_off_the_history_and_the_ligaments)
{
    Problem problem = plate();
    problem.ligaments = challenge;
    std::vector<HistoryLine> history(3);
    std::vector<LigamentState> ligaments = through_at({1, 2, -1, -1});
    history[0].force_upper = 100;
    history[0].force_lower = 300;
    history[1].force_upper = 500;
    history[1].force_lower = 300;
    history[2].force_upper = 350;
    history[2].force_lower = 350;
    history[2].energy.external = 200;
    history[2].energy.kinetic = 30;
    history[2].energy.plastic = 160;
    const auto begin = [&](std::size_t i, Real time, Real force, Real cod) {
        ligaments[i].first_time = time;
        ligaments[i].first_force = force;
        ligaments[i].first_cod = cod;
    };
    begin(0, 0.5, 8000, 2.5);
    begin(1, 1.5, 7000, 4.0);
    begin(2, 1.7, 6000, 4.5); // A-C begins too, but the path went through D

    Measures result = measures(problem, history, ligaments);
    const auto value = [&](const std::string& name) -> std::optional<Real> {
        for (const Measure& measure : result.numbers)
            if (measure.name == name) return measure.value;
        ADD_FAILURE() << name;
        return {};
    };
    EXPECT_EQ(value("peak_force_N"), 400);
    EXPECT_EQ(value("c1_force_N"), 8000);
    EXPECT_EQ(value("c1_cod_mm"), 2.5);
    EXPECT_EQ(value("c2_force_N"), 7000);
    EXPECT_EQ(value("c2_cod_mm"), 4.0);
    EXPECT_FALSE(value("c3_force_N"));
    EXPECT_FALSE(value("c3_cod_mm"));
    EXPECT_FALSE(value("c1_mean_N")); // not asked for
    EXPECT_NEAR(*value("energy_residual"), 0.05, 1e-12);
    EXPECT_EQ(result.crack_path, "A-D-C");

    begin(3, 3, 5000, 5.0); // C-E begins and continues the path
    result = measures(problem, history, ligaments);
    EXPECT_EQ(value("c3_force_N"), 5000);
    EXPECT_EQ(result.crack_path, "A-D-C");

    // A column at the rim of C belongs to B-C, too, and breaks first; C-E is the one that is cut.
    problem.ligaments.push_back({"B", "C", {}, 2});
    ligaments.emplace_back();
    begin(4, 2.5, 5500, 4.8);
    ligaments[4].front = 0.06;
    ligaments[3].front = 0.3;
    result = measures(problem, history, ligaments);
    EXPECT_EQ(value("c3_force_N"), 5000);
    ligaments[3].front = 0.06; // equal shares: the first
    result = measures(problem, history, ligaments);
    EXPECT_EQ(value("c3_force_N"), 5500);
}

TEST(Measures, of_a_run_without_ligaments_or_history_are_empty)
{
    const Measures result = measures(Problem{}, {}, {});
    EXPECT_EQ(result.numbers.size(), 11u);
    for (const Measure& measure : result.numbers) EXPECT_FALSE(measure.value) << measure.name;
    EXPECT_EQ(result.crack_path, "");
}

TEST(Measures, force_of_one_load_stands_alone)
{
    Problem problem = plate();
    EXPECT_EQ(specimen_force(problem, 1, 3), 2);
    problem.force_lower.clear();
    EXPECT_EQ(specimen_force(problem, 1, 3), 1);
}
} // namespace solver
