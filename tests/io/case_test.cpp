#include "io/case.h"

#include "case_file.h"
#include "io/atomic_file.h"
#include "io/grid_file.h"
#include "io/keys.h"
#include "io/particle_fields.h"
#include "io/vdb_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

namespace
{
using test::valid_case;
using test::with;
constexpr Real infinity = std::numeric_limits<Real>::infinity();

using Case = test::CaseFile;

/// Shapes are equal if their distances are, at points in and around everything a case here holds.
void expect_equal_shapes(const geometry::Shape& a, const geometry::Shape& b, const std::string& what)
{
    std::mt19937 engine(3);
    std::uniform_real_distribution<Real> along(-20, 40);
    for (int n = 0; n < 200; ++n) {
        const Vec3 point(along(engine), along(engine), along(engine) / 10);
        EXPECT_EQ(a.distance(point), b.distance(point)) << what;
    }
}

void expect_equal_every(const solver::OutputEvery& a, const solver::OutputEvery& b)
{
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.steps, b.steps);
    EXPECT_EQ(a.cod, b.cod);
}

void expect_equal_materials(const material::Material& a, const material::Material& b)
{
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.elastic.density, b.elastic.density);
    EXPECT_EQ(a.elastic.youngs_modulus, b.elastic.youngs_modulus);
    EXPECT_EQ(a.elastic.poisson_ratio, b.elastic.poisson_ratio);
    EXPECT_EQ(a.cell_averaged_dilatation, b.cell_averaged_dilatation);
    ASSERT_EQ(a.plastic.has_value(), b.plastic.has_value());
    if (a.plastic) {
        EXPECT_EQ(a.plastic->yield_stress, b.plastic->yield_stress);
        EXPECT_EQ(a.plastic->tangent_modulus, b.plastic->tangent_modulus);
    }
    ASSERT_EQ(a.decohesion.has_value(), b.decohesion.has_value());
    if (!a.decohesion) return;
    const material::Decohesion &x = *a.decohesion, &y = *b.decohesion;
    EXPECT_EQ(x.s_max, y.s_max);
    EXPECT_EQ(x.tau_max, y.tau_max);
    EXPECT_EQ(x.tau_max_axial, y.tau_max_axial);
    EXPECT_EQ(x.lode_memory, y.lode_memory);
    EXPECT_EQ(x.q, y.q);
    EXPECT_EQ(x.u0, y.u0);
    EXPECT_EQ(x.energy_1, y.energy_1);
    EXPECT_EQ(x.energy_2, y.energy_2);
    EXPECT_EQ(x.c_m_opening, y.c_m_opening);
    EXPECT_EQ(x.c_m_shear, y.c_m_shear);
    EXPECT_EQ(x.c_m_mixed, y.c_m_mixed);
    EXPECT_EQ(x.band_factor, y.band_factor);
    EXPECT_EQ(x.snap_back, y.snap_back);
    EXPECT_EQ(x.energy_floor_factor, y.energy_floor_factor);
    EXPECT_EQ(x.drop_transits, y.drop_transits);
    EXPECT_EQ(x.onset_strength, y.onset_strength);
    EXPECT_EQ(x.smoothed_onset, y.smoothed_onset);
    EXPECT_EQ(x.nonlocal_radius, y.nonlocal_radius);
    EXPECT_EQ(x.crack_exclusion, y.crack_exclusion);
    EXPECT_EQ(x.weak_plane, y.weak_plane);
    EXPECT_EQ(x.rotating_until, y.rotating_until);
    EXPECT_EQ(x.renewed_plane, y.renewed_plane);
    EXPECT_EQ(x.second_crack, y.second_crack);
    EXPECT_EQ(x.friction, y.friction);
}

void expect_equal_loads(const solver::Load& a, const solver::Load& b)
{
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.kind, b.kind);
    expect_equal_shapes(a.region, b.region, a.name);
    EXPECT_EQ(a.centre, b.centre);
    EXPECT_EQ(a.axis, b.axis);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_EQ(a.ramp.kind, b.ramp.kind);
    EXPECT_EQ(a.ramp.time, b.ramp.time);
}

void expect_equal_scenes(const solver::Problem& a, const solver::Problem& b)
{
    ASSERT_EQ(a.bodies.size(), b.bodies.size());
    for (std::size_t i = 0; i < a.bodies.size(); ++i) {
        EXPECT_EQ(a.bodies[i].name, b.bodies[i].name);
        EXPECT_EQ(a.bodies[i].material, b.bodies[i].material);
        EXPECT_EQ(a.bodies[i].velocity, b.bodies[i].velocity);
        expect_equal_shapes(a.bodies[i].shape, b.bodies[i].shape, a.bodies[i].name);
    }
    ASSERT_EQ(a.features.size(), b.features.size());
    for (std::size_t i = 0; i < a.features.size(); ++i) {
        EXPECT_EQ(a.features[i].name, b.features[i].name);
        EXPECT_EQ(a.features[i].centre, b.features[i].centre);
        expect_equal_shapes(a.features[i].shape, b.features[i].shape, a.features[i].name);
    }
    ASSERT_EQ(a.zones.size(), b.zones.size());
    for (std::size_t i = 0; i < a.zones.size(); ++i) {
        EXPECT_EQ(a.zones[i].name, b.zones[i].name);
        EXPECT_EQ(a.zones[i].level, b.zones[i].level);
        EXPECT_EQ(a.zones[i].margin, b.zones[i].margin);
        expect_equal_shapes(a.zones[i].shape, b.zones[i].shape, a.zones[i].name);
    }
    ASSERT_EQ(a.symmetry.size(), b.symmetry.size());
    for (std::size_t i = 0; i < a.symmetry.size(); ++i) {
        EXPECT_EQ(a.symmetry[i].axis, b.symmetry[i].axis);
        EXPECT_EQ(a.symmetry[i].at, b.symmetry[i].at);
    }
    ASSERT_EQ(a.loads.size(), b.loads.size());
    for (std::size_t i = 0; i < a.loads.size(); ++i) expect_equal_loads(a.loads[i], b.loads[i]);
}

void expect_equal_measures(const solver::Problem& a, const solver::Problem& b)
{
    ASSERT_EQ(a.gauge.has_value(), b.gauge.has_value());
    if (a.gauge) {
        EXPECT_EQ(a.gauge->upper, b.gauge->upper);
        EXPECT_EQ(a.gauge->lower, b.gauge->lower);
        EXPECT_EQ(a.gauge->axis, b.gauge->axis);
    }
    EXPECT_EQ(a.force_upper, b.force_upper);
    EXPECT_EQ(a.force_lower, b.force_lower);
    EXPECT_EQ(a.force_axis, b.force_axis);
    EXPECT_EQ(a.start_features, b.start_features);
    ASSERT_EQ(a.ligaments.size(), b.ligaments.size());
    for (std::size_t i = 0; i < a.ligaments.size(); ++i) {
        EXPECT_EQ(a.ligaments[i].from, b.ligaments[i].from);
        EXPECT_EQ(a.ligaments[i].to, b.ligaments[i].to);
        EXPECT_EQ(a.ligaments[i].through, b.ligaments[i].through);
        EXPECT_EQ(a.ligaments[i].corridor, b.ligaments[i].corridor);
    }
    EXPECT_EQ(a.end.time, b.end.time);
    EXPECT_EQ(a.end.cod, b.end.cod);
    EXPECT_EQ(a.end.separated, b.end.separated);
    ASSERT_EQ(a.references.size(), b.references.size());
    for (std::size_t i = 0; i < a.references.size(); ++i) {
        EXPECT_EQ(a.references[i].name, b.references[i].name);
        EXPECT_EQ(a.references[i].measure, b.references[i].measure);
        EXPECT_EQ(a.references[i].crack_path, b.references[i].crack_path);
    }
}

void expect_equal(const solver::Problem& a, const solver::Problem& b)
{
    EXPECT_EQ(a.title, b.title);
    EXPECT_EQ(a.gravity, b.gravity);
    EXPECT_EQ(a.grid.cell, b.grid.cell);
    EXPECT_EQ(a.grid.levels, b.grid.levels);
    EXPECT_EQ(a.grid.particles_per_cell, b.grid.particles_per_cell);
    EXPECT_EQ(a.grid.origin, b.grid.origin);
    EXPECT_EQ(a.grid.edge, b.grid.edge);
    EXPECT_EQ(a.numerics.basis, b.numerics.basis);
    EXPECT_EQ(a.numerics.formulation, b.numerics.formulation);
    EXPECT_EQ(a.numerics.stress_update, b.numerics.stress_update);
    EXPECT_EQ(a.numerics.transfer, b.numerics.transfer);
    EXPECT_EQ(a.numerics.precision, b.numerics.precision);
    EXPECT_EQ(a.numerics.pic_fraction, b.numerics.pic_fraction);
    EXPECT_EQ(a.numerics.cfl, b.numerics.cfl);
    EXPECT_EQ(a.numerics.mass_cutoff, b.numerics.mass_cutoff);
    ASSERT_EQ(a.materials.size(), b.materials.size());
    for (std::size_t i = 0; i < a.materials.size(); ++i) expect_equal_materials(a.materials[i], b.materials[i]);
    expect_equal_scenes(a, b);
    expect_equal_measures(a, b);
    expect_equal_every(a.output.history, b.output.history);
    expect_equal_every(a.output.particles, b.output.particles);
    expect_equal_every(a.output.grid, b.output.grid);
    expect_equal_every(a.output.vdb, b.output.vdb);
    EXPECT_EQ(a.output.particle_fields, b.output.particle_fields);
    EXPECT_EQ(a.output.particle_precision, b.output.particle_precision);
    EXPECT_EQ(a.output.grid_fields, b.output.grid_fields);
    EXPECT_EQ(a.output.vdb_grids, b.output.vdb_grids);
    EXPECT_EQ(a.output.vdb_preset, b.output.vdb_preset);
    EXPECT_EQ(a.output.vdb_scale, b.output.vdb_scale);
    EXPECT_EQ(a.output.checkpoint_every_wall, b.output.checkpoint_every_wall);
    EXPECT_EQ(a.output.checkpoint_keep, b.output.checkpoint_keep);
    EXPECT_EQ(a.output.checkpoint_at_end, b.output.checkpoint_at_end);
}

/// Keys of every section away from their defaults, every kind of shape.
constexpr std::string_view rich_case = R"(units = "mm-g-ms"
title = "a \"rich\" case"
gravity = [0, "-9.81 m/s^2", 0]
[grid]
cell = 1
levels = 3
particles_per_cell = 27
origin = [0.5, 0.5, 0]
edge = "staircase"
[numerics]
formulation = "updated"
transfer = "flip"
stress_update = "musl"
pic_fraction = 0.1
cfl = 0.4
mass_cutoff = 1e-8
[material."steel 1.0"]
density = 7.81e-3
youngs_modulus = 195e3
poisson_ratio = 0.31
yield_stress = 1100
tangent_modulus = 1150
dilatation = "point"
[material."steel 1.0".decohesion]
preset = "objective"
mode = "opening"
s_max = 3000
G_I = "50 kJ/m^2"
G_II = "60 kJ/m^2"
c_m = 0.7
friction = 0.2
drop_transits = 5
smoothed_onset = false
nonlocal_radius = "0.25 mm"
tau_max = 900
tau_max_axial = 1000
lode_memory = 0.05
crack_exclusion = 0.1
rotating_until = 0.5
renewed_plane = true
second_crack = true
[material.rubber]
density = 1e-3
youngs_modulus = 10
poisson_ratio = 0.4
[[feature]]
name = "edge"
centre = [10, 5, 0]
shape = { half_space = { point = [10, 0, 0], normal = [-1, 0, 0] } }
[[feature]]
name = "slit"
centre = [2, 5, 0]
shape = { tube = { points = [[0, 5, 0], [2, 5, 0]], radius = 0.4, axis = "z" } }
[[body]]
material = "steel 1.0"
velocity = [1, 2, 3]
shape = { difference = { from = { polygon = { corners = [[0, 0], [10, 0], [10, 10], [0, 10]], axis = "z", lower = 0, upper = 3 } }, holes = [ { feature = "slit" } ] } }
[[body]]
material = "rubber"
shape = { union = [ { sphere = { centre = [15, 5, 0], radius = 2 } }, { intersection = [ { box = { lower = [14, 4, 0], upper = [16, 9, 3] } }, { cylinder = { from = [15, 5, 0], to = [15, 9, 0], radius = 1 } } ] } ] }
[[refine.zone]]
shape = { polyline = ["slit", "edge"], radius = 1, axis = "z" }
level = 1
margin = 1
[[refine.zone]]
shape = { feature = "slit" }
level = 2
margin = 0.5
[load.left]
region = { box = { lower = [-1, -1, -inf], upper = [1, 4, inf] } }
velocity = [0, "free", "-1 m/s"]
[load.round]
pin = { centre = [15, 12, 0], radius = 3.5, axis = "x" }
velocity = 2
axis = "x"
ramp = { kind = "linear", time = 0.1 }
[[ligament]]
from = "slit"
to = "edge"
corridor = [[2, 4], [10, 4], [10, 6], [2, 6]]
[end]
time = 1
separated = false
[output]
history = { every_steps = 7 }
particles = { every_steps = 70, fields = ["damage"], precision = "f64" }
grid = { every_steps = 90, fields = ["stress", "density"] }
vdb = { every_time = 0.1, grids = ["velocity"], preset = "houdini", scale = 0.1 }
checkpoint = { every_wall = "20 min", keep = 3, at_end = true }
[[reference]]
name = "someone"
peak_force_N = "8.4 kN"
)";

TEST_F(Case, resolved_text_gives_an_equal_problem)
{
    for (const std::string_view text : {valid_case, rich_case}) {
        const io::Case first = io::read_case_with_warnings(write(text));
        const io::Case second = io::read_case_with_warnings(write(first.resolved, "resolved.toml"));
        expect_equal(first.problem, second.problem);
        EXPECT_EQ(first.resolved, second.resolved);
    }
}

TEST_F(Case, resolved_text_holds_every_default)
{
    const std::string text = io::read_case_with_warnings(write(valid_case)).resolved;
    for (const io::Key& key : io::all_keys())
        if (key.presence == io::Presence::defaulted && key.section.rfind("shape", 0) != 0 &&
            key.section.rfind("point", 0) != 0 && key.section.rfind("motion", 0) != 0 &&
            key.section.rfind("measure", 0) != 0 && key.section != "reference")
        {
            EXPECT_NE(text.find(std::string(key.name) + " = "), std::string::npos) << key.section << "." << key.name;
        }
}

TEST_F(Case, values_arrive_in_mm_g_ms)
{
    const solver::Problem problem = io::read_case(write(rich_case));
    EXPECT_EQ(problem.title, "a \"rich\" case");
    EXPECT_NEAR(problem.gravity[1], -9.81e-3, 1e-15);
    EXPECT_EQ(problem.grid.origin, Vec3(0.5, 0.5, 0));
    EXPECT_EQ(problem.grid.edge, solver::EdgeTreatment::staircase);
    EXPECT_EQ(problem.numerics.formulation, solver::Formulation::updated);
    EXPECT_EQ(problem.numerics.stress_update, solver::StressUpdate::musl);
    const material::Decohesion& law = *problem.materials.at(0).decohesion;
    EXPECT_EQ(law.tau_max, infinity);
    EXPECT_EQ(law.s_max, 3000);
    EXPECT_NEAR(*law.energy_1, 50, 1e-12);
    EXPECT_EQ(law.c_m_shear, 0.7);
    EXPECT_FALSE(law.u0.has_value());
    EXPECT_FALSE(problem.materials.at(0).cell_averaged_dilatation);
    EXPECT_FALSE(problem.materials.at(1).plastic.has_value());
    EXPECT_EQ(problem.bodies.at(1).material, 1);
    EXPECT_EQ(problem.bodies.at(0).velocity, Vec3(1, 2, 3));
    EXPECT_FALSE(problem.loads.at(0).velocity[1].has_value());
    EXPECT_EQ(problem.loads.at(0).velocity[2], -1);
    EXPECT_EQ(problem.loads.at(0).ramp.kind, solver::Ramp::Kind::step);
    EXPECT_EQ(problem.loads.at(1).velocity[0], 2);
    EXPECT_FALSE(problem.loads.at(1).velocity[1].has_value());
    EXPECT_EQ(problem.loads.at(1).axis, 0);
    EXPECT_EQ(problem.output.history.steps, 7);
    EXPECT_EQ(problem.output.grid.steps, 90);
    EXPECT_EQ(problem.output.grid_fields, (std::vector<std::string>{"stress", "density"}));
    EXPECT_EQ(problem.output.vdb_preset, "houdini");
    EXPECT_NEAR(problem.output.checkpoint_every_wall, 1200, 1e-9);
    EXPECT_NEAR(problem.references.at(0).measure.at("peak_force_N"), 8400, 1e-9);
}

// Nodal wherever it can be; what it cannot do falls back to flip.
TEST_F(Case, default_transfer_is_nodal_on_the_lattice_of_the_total_formulation)
{
    const auto transfer = [&](const std::vector<std::string>& overrides) {
        return io::read_case(write(valid_case), overrides).numerics.transfer;
    };
    using enum solver::Transfer;
    EXPECT_EQ(transfer({}), nodal);
    EXPECT_EQ(transfer({"numerics.stress_update=usl", "grid.particles_per_cell=8"}), nodal);
    EXPECT_EQ(transfer({"numerics.formulation=updated"}), flip);
    EXPECT_EQ(transfer({"numerics.formulation=updated", "numerics.stress_update=usl"}), flip);
    EXPECT_EQ(transfer({"numerics.stress_update=musl"}), flip);
    EXPECT_EQ(transfer({"grid.particles_per_cell=27"}), flip);
    EXPECT_EQ(transfer({"numerics.pic_fraction=0.1"}), flip);
    EXPECT_EQ(transfer({"numerics.transfer=flip"}), flip);
    EXPECT_EQ(transfer({"numerics.transfer=apic"}), apic);
}

// Decision 028.
TEST_F(Case, default_precision_is_mixed_where_motion_is_on_the_nodes)
{
    const auto precision = [&](const std::vector<std::string>& overrides) {
        return io::read_case(write(valid_case), overrides).numerics.precision;
    };
    using enum solver::Precision;
    EXPECT_EQ(precision({}), mixed);
    EXPECT_EQ(precision({"numerics.precision=f64"}), f64);
    EXPECT_EQ(precision({"numerics.transfer=flip"}), f64);
    EXPECT_EQ(precision({"numerics.formulation=updated"}), f64);
    EXPECT_EQ(precision({"grid.particles_per_cell=27"}), f64);
    const std::string resolved = io::read_case_with_warnings(write(valid_case)).resolved;
    EXPECT_NE(resolved.find("precision = \"mixed\""), std::string::npos);
    EXPECT_EQ(io::read_case(write(resolved)).numerics.precision, mixed);
}

TEST_F(Case, shear_strength_of_tension_bars)
{
    const std::string text = with(valid_case, "tau_max =", "tau_max_axial = \"1 GPa\"\ntau_max =");
    const auto law = [&](std::string_view file, const std::vector<std::string>& overrides = {}) {
        return *io::read_case(write(file), overrides).materials.at(0).decohesion;
    };
    EXPECT_NEAR(law(text).tau_max_axial.value(), 1000, 1e-9);
    EXPECT_FALSE(law(valid_case).tau_max_axial.has_value());
    const std::vector<std::string> opening{"material.steel.decohesion.mode=opening"};
    EXPECT_FALSE(law(text, opening).tau_max_axial.has_value()); // no mode II at all
    EXPECT_NEAR(law(io::read_case_with_warnings(write(text)).resolved).tau_max_axial.value(), 1000, 1e-9);
}

TEST_F(Case, paper_preset)
{
    const std::string text =
        with(valid_case, "s_max = \"4900 MPa\"\ntau_max = \"820 MPa\"\nu0 = \"2e-7 m\"", "preset = \"paper\"");
    const material::Decohesion law = *io::read_case(write(text)).materials.at(0).decohesion;
    EXPECT_EQ(law.s_max, 4900);
    EXPECT_EQ(law.tau_max, 820);
    EXPECT_EQ(*law.u0, 2e-4);
    EXPECT_EQ(law.q, 1);
    EXPECT_EQ(law.snap_back, material::SnapBack::brittle_drop);
    EXPECT_FALSE(law.smoothed_onset);
    EXPECT_EQ(law.onset_strength, material::OnsetStrength::plane);
    EXPECT_EQ(io::read_case(write(text), {"material.steel.decohesion.mode=shear"}).materials.at(0).decohesion->s_max,
              infinity);
}

TEST_F(Case, corridor_lies_between_the_common_tangents)
{
    const solver::Ligament ligament = io::read_case(write(valid_case)).ligaments.at(0);
    // A at (2, 5) with radius 1, B at (8, 5) with 1.5; 4 finest cells are 2 mm, as wide as A.
    const std::vector<std::array<Real, 2>> expected{{2, 4}, {8, 4}, {8, 6}, {2, 6}};
    ASSERT_EQ(ligament.corridor.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(ligament.corridor[i][k], expected[i][k], 1e-12);
}

TEST_F(Case, including_file_wins_and_arrays_of_tables_join)
{
    write(valid_case, "common.toml");
    const solver::Problem problem = io::read_case(
        write("include = \"common.toml\"\n[grid]\ncell = 0.5\n[[refine.zone]]\nname = \"more\"\nlevel = 1\n"
              "shape = { feature = \"B\" }\nmargin = 1\n"));
    EXPECT_EQ(problem.grid.cell, 0.5);
    EXPECT_EQ(problem.grid.levels, 2);
    ASSERT_EQ(problem.zones.size(), 2U);
    EXPECT_EQ(problem.zones[0].name, "between");
    EXPECT_EQ(problem.zones[1].name, "more");
}

TEST_F(Case, overrides_reach_every_value)
{
    const solver::Problem problem =
        io::read_case(write(valid_case), {"grid.cell=0.5", "end.time=2 us", "feature.A.centre=[2, 5.1, 0]",
                                          "refine.zone.0.margin=0.25", "title=\"shifted\""});
    EXPECT_EQ(problem.grid.cell, 0.5);
    EXPECT_NEAR(problem.end.time, 2e-3, 1e-15);
    EXPECT_EQ(problem.features.at(0).centre[1], 5.1);
    EXPECT_NEAR(problem.features.at(0).shape.distance(Vec3(2, 5.1, 7)), -1, 1e-12);
    EXPECT_EQ(problem.zones.at(0).margin, 0.25);
    EXPECT_EQ(problem.title, "shifted");
}

TEST_F(Case, warnings_have_places)
{
    std::string text = with(valid_case, "levels = 2", "levels = 3");
    text = with(text, "level = 1", "level = 2");
    text = with(text, "\"2 m/s\"", "\"200 m/s\"");
    const io::Case read = io::read_case_with_warnings(write(text));
    ASSERT_EQ(read.warnings.size(), 2U);
    EXPECT_NE(
        read.warnings[0].find("case.toml:29:9: warning: level jump above 1 at the rim of zone 'between' (level 2)"),
        std::string::npos);
    EXPECT_NE(read.warnings[1].find("warning: load 'pin' moves at 200 mm/ms, 3.4 % of the slowest wave speed"),
              std::string::npos);
    const std::string ring = text + "[[refine.zone]]\nlevel = 1\nshape = { polyline = [\"A\", \"B\"], radius = 3 }\n";
    EXPECT_EQ(io::read_case_with_warnings(write(ring)).warnings.size(), 1U);
}

/// Reads or refuses with InputError; anything else fails the test.
void expect_refused_or_read(const std::filesystem::path& file, const std::string& what)
{
    try {
        (void)io::read_case(file);
    } catch (const core::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("error: "), std::string::npos) << what;
    } catch (const std::exception& error) {
        ADD_FAILURE() << what << ": " << error.what();
    }
}

TEST_F(Case, any_line_may_be_missing_or_hold_anything)
{
    std::vector<std::string> lines;
    std::istringstream stream{std::string(rich_case)};
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    for (std::size_t changed = 0; changed < lines.size(); ++changed)
        for (const char* value : {"", "true", "-1", "[{}]", "{ time = -inf }"}) {
            std::string text;
            for (std::size_t n = 0; n < lines.size(); ++n) {
                const std::size_t equals = lines[n].find(" = ");
                if (n != changed)
                    text += lines[n] + "\n";
                else if (*value && equals != std::string::npos)
                    text += lines[n].substr(0, equals) + " = " + value + "\n";
            }
            expect_refused_or_read(write(text), lines[changed] + " <- " + value);
        }
}

TEST(Cases, shipped_cases_are_valid)
{
    const support::Folder scratch;
    int count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(CLEAVE_SOURCE_DIR "/cases")) {
        if (entry.path().extension() != ".toml") continue;
        if (entry.path().stem() == "common" || entry.path().stem() == "plate") continue; // parts that cases include
        if (const auto folder = entry.path().parent_path().stem();
            folder == "point" || folder == "chart" || folder == "sweep")
            continue; // not cases to run: point_case_test.cpp, suite_test.cpp
        ++count;
        const io::Case read = io::read_case_with_warnings(entry.path());
        EXPECT_TRUE(read.warnings.empty()) << entry.path() << "\n" << read.warnings.front();
        io::write_file(scratch / "resolved.toml", read.resolved);
        EXPECT_EQ(io::read_case_with_warnings(scratch / "resolved.toml").resolved, read.resolved) << entry.path();
    }
    EXPECT_GE(count, 3);
}

TEST(Keys, names_are_unique_and_explained)
{
    std::vector<std::string> seen;
    for (const io::Key& key : io::all_keys()) {
        const std::string name = std::string(key.section) + "/" + std::string(key.name);
        EXPECT_EQ(std::count(seen.begin(), seen.end(), name), 0) << name;
        seen.push_back(name);
        EXPECT_FALSE(key.meaning.empty()) << name;
        EXPECT_EQ(key.presence == io::Presence::defaulted, !key.fallback.empty()) << name;
        EXPECT_EQ(key.type == io::Type::choice && key.choices.empty(), false) << name;
    }
}

TEST(Keys, choices_of_grid_files_are_those_of_the_writer)
{
    const std::vector<std::string> fields = io::choices_of(io::key_of("output.grid", "fields"));
    EXPECT_TRUE(std::equal(fields.begin(), fields.end(), io::grid_field_names.begin(), io::grid_field_names.end()));
    for (const std::string& name : fields) EXPECT_TRUE(name == "density" || io::find_particle_field(name)) << name;
}

TEST(Keys, choices_of_volumes_are_those_of_the_writer)
{
    const std::vector<std::string> grids = io::choices_of(io::key_of("output.vdb", "grids"));
    EXPECT_TRUE(std::equal(grids.begin(), grids.end(), io::vdb_grid_names.begin(), io::vdb_grid_names.end()));
    const std::vector<std::string> presets = io::choices_of(io::key_of("output.vdb", "preset"));
    EXPECT_TRUE(std::equal(presets.begin(), presets.end(), io::vdb_presets.begin(), io::vdb_presets.end()));
}
} // namespace
