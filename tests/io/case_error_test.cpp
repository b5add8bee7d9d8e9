#include "case_file.h"

namespace
{
using test::valid_case;
using test::with;
using testing::AssertionFailure;
using testing::AssertionResult;
using testing::AssertionSuccess;

AssertionResult contains(const std::string& text, const std::string& part)
{
    if (text.find(part) != std::string::npos) return AssertionSuccess();
    return AssertionFailure() << "expected\n" << part << "\nin\n" << text;
}

class CaseError : public test::CaseFile
{
protected:
    std::vector<std::string> warnings(std::string_view text) const
    {
        return io::read_case_with_warnings(write(text)).warnings;
    }
};

AssertionResult one_error(const std::string& text, const std::string& part)
{
    if (!text.ends_with("\n1 error")) return AssertionFailure() << "not one error:\n" << text;
    return contains(text, part);
}

TEST_F(CaseError, misspelt_key)
{
    EXPECT_EQ(
        complaint(with(valid_case, "tau_max =", "tau_mx =")),
        "case.toml:10:1: error: missing key 'tau_max' in [material.steel.decohesion]\n"
        "   10 | [material.steel.decohesion]\n"
        "      | ^~~~~~~~~~~~~~~~~~~~~~~~~~~  or preset = \"paper\", or mode = \"opening\" or \"shear\"\n"
        "case.toml:12:1: error: unknown key 'tau_mx' in [material.steel.decohesion]\n"
        "   12 | tau_mx = \"820 MPa\"\n"
        "      | ^~~~~~  did you mean 'tau_max'?\n"
        "   keys here: G_I, G_II, band_factor, c_m, c_m_mixed, c_m_opening, c_m_shear, crack_exclusion, "
        "drop_transits, energy_floor_factor, friction, lode_memory, mode, nonlocal_radius, onset_strength, preset, q, "
        "renewed_plane, rotating_until, s_max, second_crack, smoothed_onset, snap_back, tau_max, tau_max_axial, u0, "
        "weak_plane     "
        "(cleave keys material.decohesion)\n"
        "2 errors");
}

TEST_F(CaseError, weak_plane_needs_a_normal_and_does_not_rotate)
{
    const std::string text = complaint(with(valid_case, "tau_max =",
                                            "weak_plane = [0, 0, 0]\nrotating_until = 0.5\nrenewed_plane = "
                                            "true\nsecond_crack = true\ntau_max_axial = 900\ntau_max ="));
    EXPECT_TRUE(contains(text, "case.toml:12:14: error: a plane needs a normal other than zero\n"));
    EXPECT_TRUE(contains(text, "case.toml:13:18: error: a weak_plane does not rotate\n"));
    EXPECT_TRUE(contains(text, "case.toml:14:17: error: a weak_plane stays where it is\n"));
    EXPECT_TRUE(contains(text, "case.toml:15:16: error: a weak_plane is the only plane that can break\n"));
    EXPECT_TRUE(contains(text, "case.toml:16:17: error: a weak_plane compares the shear on it with tau_max alone\n"));
}

TEST_F(CaseError, lode_memory_needs_a_ball_and_two_strengths)
{
    const std::string text = complaint(with(valid_case, "tau_max =", "lode_memory = 0.05\ntau_max ="));
    EXPECT_TRUE(contains(text, "case.toml:12:15: error: lode_memory belongs to the nonlocal onset\n"));
    EXPECT_TRUE(contains(text, "add a nonlocal_radius"));
    EXPECT_TRUE(contains(text, "case.toml:12:15: error: without tau_max_axial all states have one strength\n"));
}

TEST_F(CaseError, a_radius_that_makes_no_mean)
{
    const auto with_radius = [](const std::string& radius) {
        return with(valid_case, "u0 =", "nonlocal_radius = " + radius + "\nu0 =");
    };
    EXPECT_TRUE(warnings(with_radius("0.5")).empty());
    const std::vector<std::string> small = warnings(with_radius("0.4")), large = warnings(with_radius("11"));
    ASSERT_EQ(small.size(), 1U);
    EXPECT_TRUE(
        contains(small[0], "case.toml:13:19: warning: nonlocal_radius 0.4 mm is below the finest cells, 0.5 mm"));
    ASSERT_EQ(large.size(), 1U);
    EXPECT_TRUE(contains(large[0], "case.toml:13:19: warning: nonlocal_radius 11 mm is more than the bodies of 'steel' "
                                   "are long, 10 mm"));
}

// One mistake, and nothing about what it would have given.
TEST_F(CaseError, a_misspelt_value_is_one_error)
{
    const std::string law = "s_max = \"4900 MPa\"\ntau_max = \"820 MPa\"\nu0 = \"2e-7 m\"\n";
    EXPECT_TRUE(one_error(complaint(with(valid_case, law, "preset = \"papr\"\n")), "did you mean 'paper'?"));
    EXPECT_TRUE(one_error(complaint(with(valid_case, law, "mode = \"openin\"\n")), "did you mean 'opening'?"));
    EXPECT_TRUE(one_error(complaint(valid_case, {"load.base.axis=w"}), "--set:1:16: error: 'axis' is not an axis"));
    EXPECT_TRUE(one_error(complaint(std::string(valid_case) + "[[measure]]\nname = \"f\"\nat = \"fourrier\"\n"
                                                              "frequency = 3\nenergy = { what = \"kinetic\" }\n"),
                          "did you mean 'fourier'?"));
}

// The hole is cut out of the body, and the zone and the gauge lie beside it: nothing is said of these.
TEST_F(CaseError, a_wrong_feature_is_one_error)
{
    const std::string text = complaint(with(valid_case, "centre = [8, 5, 0]", "centre = [8, 5]"));
    EXPECT_TRUE(contains(text, "case.toml:18:10: error: "));
    EXPECT_TRUE(text.ends_with("\n1 error")) << text;
}

TEST_F(CaseError, a_measure_outside_every_body)
{
    const std::string text =
        complaint(std::string(valid_case) + "[[measure]]\nname = \"far\"\nprobe = { field = "
                                            "\"displacement\", component = \"y\", point = [100, 1, 1] }\n");
    EXPECT_TRUE(contains(text, "error: a point of measure 'far' lies 90 mm outside every body\n"));
    EXPECT_TRUE(text.ends_with("\n1 error")) << text;
}

TEST_F(CaseError, a_gauge_without_forces_is_a_warning)
{
    const std::string text = with(valid_case, "[forces]\nupper = \"pin\"\nlower = \"base\"\n", "");
    const std::vector<std::string> found = warnings(text);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_TRUE(contains(found[0], "no [forces]"));
}

TEST_F(CaseError, misspelt_section)
{
    const std::string text = complaint(with(valid_case, "[forces]", "[force]"));
    EXPECT_TRUE(contains(text, "error: unknown key 'force' at the top of the case\n"
                               "   42 | [force]\n"
                               "      |  ^~~~~  did you mean 'forces'?\n"));
    EXPECT_TRUE(contains(text, "(cleave keys case)"));
}

TEST_F(CaseError, wrong_unit)
{
    EXPECT_EQ(complaint(with(valid_case, "\"195 GPa\"", "\"195 mm\"")),
              "case.toml:7:18: error: '195 mm' is a length, but 'youngs_modulus' is a stress\n"
              "    7 | youngs_modulus = \"195 mm\"\n"
              "      |                  ^~~~~~~~  expected stress > 0 [MPa], such as \"195 GPa\"\n"
              "1 error");
}

TEST_F(CaseError, unknown_unit)
{
    EXPECT_TRUE(contains(complaint(with(valid_case, "195 GPa", "195 Gpa")),
                         "case.toml:7:18: error: 'Gpa' is not a unit known here\n"));
}

TEST_F(CaseError, zone_outside_every_body)
{
    EXPECT_EQ(complaint(with(valid_case, "{ polyline = [\"A\", \"B\"], radius = 1.5 }",
                             "{ sphere = { centre = [50, 0, 0], radius = 2 } }")),
              "case.toml:29:9: error: zone 'between' lies outside every body\n"
              "   29 | shape = { sphere = { centre = [50, 0, 0], radius = 2 } }\n"
              "      |         ^~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~  refines nothing\n"
              "1 error");
}

TEST_F(CaseError, zone_inside_a_hole)
{
    EXPECT_TRUE(contains(complaint(with(valid_case, "{ polyline = [\"A\", \"B\"], radius = 1.5 }",
                                        "{ sphere = { centre = [8, 5, 1], radius = 1.4 } }")),
                         "zone 'between' lies outside every body"));
}

// What a run would refuse, or silently leave out, is told with its place in the file.
TEST_F(CaseError, bodies_loads_and_zones_that_the_mesh_does_not_see)
{
    EXPECT_TRUE(contains(complaint(with(valid_case, "lower = [-1, -1, -1], upper = [11, 1, 3]",
                                        "lower = [-1, 0.2, -1], upper = [11, 0.8, 3]")),
                         "case.toml:36:10: error: load 'base' holds no node with mass\n"));
    EXPECT_TRUE(contains(complaint(with(valid_case, "upper = [10, 10, 2]", "upper = [10, 10, 0.005]")),
                         "case.toml:23:9: error: body 'plate' gets no particle\n"));
    const std::string twice = std::string(valid_case) +
                              "[[body]]\nname = \"patch\"\nmaterial = \"steel\"\n"
                              "shape = { box = { lower = [0, 9, 0], upper = [10, 11, 2] } }\n";
    EXPECT_TRUE(contains(complaint(twice), "case.toml:55:9: error: body 'patch' overlaps body 'plate'\n"));
    EXPECT_EQ(complaint(with(twice, "[0, 9, 0]", "[0, 10, 0]")), "");
    const io::Case read =
        io::read_case_with_warnings(write(with(valid_case, "{ polyline = [\"A\", \"B\"], radius = 1.5 }",
                                               "{ box = { lower = [5.1, 5.1, 0.1], upper = [5.4, 5.4, 0.4] } }")));
    ASSERT_EQ(read.warnings.size(), 1U);
    EXPECT_TRUE(contains(read.warnings.front(), "warning: zone 'between' refines nothing"));
}

// The centres of these cells lie in the holes, as it happens.
TEST_F(CaseError, cells_too_wide_to_meet_what_is_there)
{
    const std::string text = complaint(with(valid_case, "cell = 1\n", "cell = \"0.5 in\"\n"));
    EXPECT_EQ(text.find("outside every body"), std::string::npos) << text;
    EXPECT_TRUE(one_error(text, "cells of level 0 are 12.7 mm wide"));
    const std::vector<std::string> thin = warnings(with(valid_case, "upper = [10, 10, 2]", "upper = [10, 10, 0.4]"));
    ASSERT_EQ(thin.size(), 1U);
    EXPECT_TRUE(contains(thin[0], "case.toml:3:8: warning: cells of 0.5 mm, the finest, are wider than body 'plate' "
                                  "along z: 0.4 mm"));
}

TEST_F(CaseError, zone_level_beyond_the_finest)
{
    EXPECT_TRUE(contains(complaint(with(valid_case, "level = 1", "level = 2")),
                         "case.toml:30:9: error: zone 'between' asks for level 2, but the finest is 1\n"
                         "   30 | level = 2\n"
                         "      |         ^  levels count from 0: set grid.levels = 3 for it\n"));
}

TEST_F(CaseError, velocity_not_a_number)
{
    EXPECT_EQ(complaint(with(valid_case, "[0, \"2 m/s\", \"free\"]", "[0, nan, \"free\"]")),
              "case.toml:33:16: error: 'velocity' must be a finite number, not nan\n"
              "   33 | velocity = [0, nan, \"free\"]\n"
              "      |                ^~~  expected velocity [mm/ms]\n"
              "1 error");
}

TEST_F(CaseError, infinity_only_where_it_means_something)
{
    EXPECT_EQ(complaint(with(valid_case, "s_max = \"4900 MPa\"", "s_max = inf")), "");
    EXPECT_TRUE(contains(complaint(with(valid_case, "density = \"7.81e-3 g/mm^3\"", "density = inf")),
                         "'density' must be a finite number, not inf"));
}

TEST_F(CaseError, boxes_where_they_change_nothing)
{
    const std::string text = std::string(valid_case) + "[numerics]\nbasis = \"gimp\"\n";
    const io::Case read = io::read_case_with_warnings(write(text));
    ASSERT_EQ(read.warnings.size(), 1U);
    EXPECT_TRUE(contains(read.warnings[0], "warning: basis = \"gimp\" changes nothing in the total formulation\n"));
    EXPECT_EQ(complaint(text + "formulation = \"updated\"\n"), "");
}

TEST_F(CaseError, nodal_transfer_off_its_lattice)
{
    const std::string text = std::string(valid_case) + "[numerics]\ntransfer = \"nodal\"\n";
    EXPECT_EQ(complaint(text), "");
    const std::string error = "error: transfer = \"nodal\" needs formulation = \"total\", stress_update = \"usl\" and "
                              "grid.particles_per_cell = 8\n";
    EXPECT_TRUE(contains(complaint(text + "formulation = \"updated\"\n"), error));
    EXPECT_TRUE(contains(complaint(text + "stress_update = \"musl\"\n"), error));
    EXPECT_TRUE(contains(complaint(with(text, "levels = 2", "levels = 2\nparticles_per_cell = 27")), error));
    EXPECT_TRUE(contains(complaint(text + "formulation = \"updated\"\n"), "choose \"flip\" or \"apic\""));
    EXPECT_TRUE(
        contains(complaint(text + "pic_fraction = 0.1\n"), "error: pic_fraction belongs to transfer = \"flip\""));
}

TEST_F(CaseError, mixed_precision_without_the_nodal_scheme)
{
    const std::string text = std::string(valid_case) + "[numerics]\nprecision = \"mixed\"\n";
    EXPECT_EQ(complaint(text), "");
    const std::string error = "error: precision = \"mixed\" needs transfer = \"nodal\"\n";
    EXPECT_TRUE(contains(complaint(text + "transfer = \"flip\"\n"), error));
    EXPECT_TRUE(contains(complaint(text + "transfer = \"apic\"\n"), error));
    EXPECT_TRUE(contains(complaint(text + "formulation = \"updated\"\n"), error)); // flip by default
}

TEST_F(CaseError, subcycling_that_cannot_be)
{
    const std::string text = std::string(valid_case) + "[numerics]\nsubcycling = true\n";
    EXPECT_EQ(complaint(text + "cfl = 0.6\n"), "");
    const std::string error = "error: subcycling = true needs transfer = \"nodal\"\n";
    EXPECT_TRUE(contains(complaint(text + "transfer = \"flip\"\n"), error));
    EXPECT_TRUE(contains(complaint(text + "formulation = \"updated\"\n"), error));
    EXPECT_TRUE(contains(complaint(text + "cfl = 0.61\n"), "error: cfl must be at most 0.6 with subcycling"));
    EXPECT_TRUE(contains(complaint(std::string(valid_case) + "[numerics]\nsubcycling = 1\n"), "subcycling"));
    EXPECT_TRUE(contains(complaint(text + "damping = 3\n"), "error: damping is not built for steps that differ"));
}

TEST_F(CaseError, damping_memory_without_motion_on_the_nodes)
{
    const std::string text = std::string(valid_case) + "[numerics]\ndamping = 3\ndamping_memory = 0.1\n";
    EXPECT_EQ(complaint(text), "");
    EXPECT_TRUE(
        contains(complaint(text + "transfer = \"flip\"\n"), "error: damping_memory needs transfer = \"nodal\""));
    EXPECT_TRUE(contains(complaint(std::string(valid_case) + "[numerics]\ndamping_memory = -0.1\n"), "damping_memory"));
    const std::string idle = std::string(valid_case) + "[numerics]\ndamping_memory = 0.1\n";
    const std::vector<std::string> found = warnings(idle);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_TRUE(contains(found[0], "warning: damping_memory changes nothing without damping"));
}

TEST_F(CaseError, missing_file)
{
    try {
        (void)io::read_case(directory() / "none.toml");
        FAIL();
    } catch (const core::FileError& error) {
        EXPECT_EQ(std::string(error.what()),
                  "cannot read the case file '" + (directory() / "none.toml").string() + "': no such file");
    }
}

TEST_F(CaseError, missing_include)
{
    EXPECT_TRUE(contains(complaint("include = \"other.toml\"\nunits = \"mm-g-ms\"\n"),
                         "case.toml:1:11: error: cannot read the included file"));
}

TEST_F(CaseError, include_circle)
{
    EXPECT_TRUE(contains(complaint("include = \"case.toml\"\n"), "includes itself"));
}

TEST_F(CaseError, position_in_an_included_file)
{
    write(with(valid_case, "poisson_ratio = 0.3", "poisson_ratio = 0.5"), "common.toml");
    EXPECT_TRUE(contains(complaint("include = \"common.toml\"\n[grid]\ncell = 0.5\n"),
                         "common.toml:8:17: error: 'poisson_ratio' is out of range: 0.5\n"
                         "    8 | poisson_ratio = 0.5\n"
                         "      |                 ^~~  expected number without unit above -1 and below 0.5\n"));
}

TEST_F(CaseError, several_at_once)
{
    std::string text = with(valid_case, "cell = 1\n", "cell = 1\nparticles_per_cell = 10\n");
    text = with(text, "poisson_ratio = 0.3", "poisson_ratio = \"high\"");
    text = with(text, "at = 0", "at = -0.3");
    text = with(text, "upper = \"pin\"", "upper = \"pn\"");
    const std::string all = complaint(text);
    EXPECT_TRUE(contains(all, "case.toml:4:22: error: particles_per_cell = 10 is not a cube number"));
    EXPECT_TRUE(contains(all, "case.toml:9:17: error: 'high' does not begin with a number"));
    EXPECT_TRUE(contains(all, "case.toml:27:6: error: the symmetry plane z = -0.3 is not on a node plane of level 0\n"
                              "   27 | at = -0.3\n"
                              "      |      ^~~~  nearest: 0\n"));
    EXPECT_TRUE(contains(all, "error: there is no load 'pn'\n"));
    EXPECT_TRUE(contains(all, "did you mean 'pin'?"));
    EXPECT_TRUE(contains(all, "\n4 errors"));
    // In the order of the file, although the first is found last.
    EXPECT_LT(all.find("case.toml:4:22"), all.find("case.toml:9:17"));
}

TEST_F(CaseError, syntax)
{
    EXPECT_TRUE(contains(complaint("units = \"mm-g-ms\"\n[grid\ncell = 1\n"), "case.toml:2:6: error: "));
}

TEST_F(CaseError, units_must_be_declared)
{
    EXPECT_TRUE(contains(complaint(with(valid_case, "units = \"mm-g-ms\"\n", "")), "error: missing key 'units'"));
    EXPECT_TRUE(contains(complaint(with(valid_case, "mm-g-ms", "SI")), "'SI' is not a value of 'units'"));
}

TEST_F(CaseError, unknown_names)
{
    EXPECT_TRUE(contains(complaint(with(valid_case, "material = \"steel\"", "material = \"stel\"")),
                         "there is no material 'stel'"));
    EXPECT_TRUE(contains(complaint(with(valid_case, "{ polyline = [\"A\", \"B\"]", "{ polyline = [\"A\", \"Q\"]")),
                         "there is no feature 'Q'"));
    EXPECT_TRUE(contains(complaint(std::string(valid_case) + "[output.particles]\nfields = [\"damge\"]\n"),
                         "did you mean 'damage'?"));
}

TEST_F(CaseError, shapes)
{
    const auto with_zone = [](const std::string& shape) {
        return with(valid_case, "{ polyline = [\"A\", \"B\"], radius = 1.5 }", shape);
    };
    EXPECT_TRUE(contains(complaint(with_zone("{ box = { lower = [0, 0, 0], upper = [1, 0, 1] } }")),
                         "a box needs upper > lower"));
    EXPECT_TRUE(contains(complaint(with_zone("{ sphere = { centre = [0, 0, 0], radius = -1 } }")),
                         "'radius' is out of range: -1"));
    EXPECT_TRUE(
        contains(complaint(with_zone("{ spere = { centre = [0, 0, 0], radius = 1 } }")), "did you mean 'sphere'?"));
    EXPECT_TRUE(contains(complaint(with_zone("{ union = [] }")), "list of at least one shape"));
    EXPECT_TRUE(contains(complaint(with_zone("{ polyline = [\"A\", \"B\"] }")), "a polyline needs a radius"));
    EXPECT_TRUE(contains(complaint(with_zone("\"sphere\"")), "'refine.zone.shape' must be a shape"));
    EXPECT_TRUE(contains(complaint(with_zone("{ half_space = { point = [0, 0, 0], normal = [0, 0, 0] } }")),
                         "a normal that is not zero"));
}

TEST_F(CaseError, material_values)
{
    EXPECT_TRUE(contains(complaint(with(valid_case, "7.81e-3 g/mm^3", "-1 g/mm^3")), "'density' is out of range: -1"));
    EXPECT_TRUE(contains(complaint(with(valid_case, "yield_stress = 1100", "yield_stress = 0")),
                         "'yield_stress' is out of range: 0"));
    EXPECT_TRUE(contains(complaint(with(valid_case, "yield_stress = 1100", "yield_stress = 1\ntangent_modulus = 2e5")),
                         "is not below youngs_modulus"));
    EXPECT_TRUE(contains(complaint(with(valid_case, "u0 =", "G_I = 1\nu0 =")), "either u0 or the energies"));
    EXPECT_TRUE(contains(complaint(with(valid_case, "u0 = \"2e-7 m\"", "preset = \"objective\"")),
                         "needs the fracture energies"));
}

TEST_F(CaseError, loads)
{
    EXPECT_TRUE(
        contains(complaint(with(valid_case, "pin = { feature = \"A\" }", "pin = { centre = [100, 0, 0], radius = 1 }")),
                 "load 'pin' touches no body"));
    EXPECT_TRUE(
        contains(complaint(with(valid_case, "velocity = 0\naxis = \"y\"", "velocity = 0")), "needs a direction"));
    EXPECT_TRUE(contains(complaint(with(valid_case, "ramp = { time = \"50 us\" }", "ramp = { kind = \"linear\" }")),
                         "this ramp needs a time > 0"));
}

TEST_F(CaseError, loads_that_contradict_each_other)
{
    const auto again = [](const std::string& motion) {
        return std::string(valid_case) +
               "[load.again]\nregion = { box = { lower = [-1, -1, -1], upper = [11, 1, 3] } }\n" + motion;
    };
    const std::vector<std::string> other = warnings(again("velocity = 1\naxis = \"y\"\n"));
    ASSERT_EQ(other.size(), 1U);
    EXPECT_TRUE(contains(other[0], "case.toml:53:10: warning: load 'again' has the region of load 'base' and another "
                                   "velocity along y\n"));
    EXPECT_TRUE(warnings(again("velocity = 1\naxis = \"x\"\n")).empty());
    EXPECT_TRUE(warnings(again("velocity = 0\naxis = \"y\"\nramp = { time = 1 }\n")).empty());
    EXPECT_TRUE(one_error(complaint(with(valid_case, "lower = \"base\"", "lower = \"pin\"")),
                          "case.toml:44:9: error: 'upper' and 'lower' are the same load 'pin'\n"));
}

TEST_F(CaseError, the_same_twice)
{
    const std::string text(valid_case);
    EXPECT_TRUE(one_error(complaint(text + "[[body]]\nname = \"plate\"\nmaterial = \"steel\"\n"
                                           "shape = { box = { lower = [0, 10, 0], upper = [10, 11, 2] } }\n"),
                          "case.toml:53:8: error: there are two bodies 'plate'\n"));
    const std::string zone = "[[refine.zone]]\nname = \"between\"\nshape = { feature = \"A\" }\nmargin = 1\nlevel = ";
    EXPECT_TRUE(one_error(complaint(text + zone + "1\n"), "case.toml:53:8: error: there are two zones 'between' of"));
    EXPECT_EQ(complaint(with(text, "levels = 2", "levels = 3") + zone + "2\n"), ""); // refined twice
    EXPECT_TRUE(one_error(complaint(text + "[[ligament]]\nfrom = \"B\"\nto = \"A\"\n"),
                          "case.toml:53:8: error: there are two ligaments of 'B' and 'A'\n"));
    EXPECT_TRUE(one_error(complaint(text + "[output.particles]\nfields = [\"damage\", \"damage\"]\n"),
                          "case.toml:53:21: error: 'damage' stands twice in 'fields'\n"));
}

TEST_F(CaseError, measures_that_cannot_be)
{
    const auto measured = [](const std::string& lines) { return std::string(valid_case) + "[[measure]]\n" + lines; };
    EXPECT_TRUE(one_error(complaint(measured("name = \"status\"\nenergy = { what = \"kinetic\" }\n")),
                          "case.toml:53:8: error: 'status' has a meaning in the results of every run already\n"));
    const std::string region = "region = { sphere = { centre = [5, 5, 1], radius = 2 } } }\n";
    EXPECT_TRUE(one_error(complaint(measured("name = \"e\"\ncrack = { what = \"energy\", " + region)),
                          "error: the energy of cracks is kept for the whole model\n"));
    EXPECT_EQ(complaint(measured("name = \"e\"\ncrack = { what = \"softening\", " + region)), "");
    const std::string moved = "name = \"u\"\nload = { name = \"base\", what = \"displacement\", component = ";
    EXPECT_TRUE(one_error(complaint(measured(moved + "\"x\" }\n")),
                          "error: load 'base' leaves x free: its displacement there is 0\n"));
    EXPECT_EQ(complaint(measured(moved + "\"y\" }\n")), "");
}

TEST_F(CaseError, numbers_beyond_the_machine)
{
    EXPECT_TRUE(one_error(complaint(with(valid_case, "levels = 2", "levels = 3000000000")),
                          "case.toml:4:10: error: 'levels' is out of range: 3000000000\n"));
}

TEST_F(CaseError, a_file_that_is_no_text)
{
    const std::string text = complaint("units = \x01\x1b[2J\n");
    EXPECT_TRUE(contains(text, "    1 | units = ??[2J\n"));
}

TEST_F(CaseError, forces_need_a_load)
{
    EXPECT_TRUE(contains(complaint(with(valid_case, "upper = \"pin\"\nlower = \"base\"", "axis = \"y\"")),
                         "[forces] names no load"));
}

TEST_F(CaseError, body_across_a_symmetry_plane)
{
    EXPECT_TRUE(contains(complaint(with(valid_case, "at = 0", "at = 1")),
                         "body 'plate' lies on both sides of the symmetry plane z = 1"));
}

TEST_F(CaseError, gauge_far_from_the_material)
{
    EXPECT_TRUE(contains(complaint(with(valid_case, "upper = [5, 6, 0]", "upper = [5, 16, 0]")),
                         "gauge point 'upper' lies 6 mm outside every body"));
}

TEST_F(CaseError, opening_without_a_gauge)
{
    const std::string text = with(valid_case, "[gauge.cod]\nupper = [5, 6, 0]\nlower = [5, 4, 0]\n", "");
    EXPECT_TRUE(contains(complaint(text), "the end by opening needs a gauge"));
}

TEST_F(CaseError, more_particles_than_a_run_can_number)
{
    const std::string text = complaint(with(valid_case, "cell = 1\n", "cell = 0.001\n"));
    EXPECT_TRUE(contains(text, "case.toml:3:8: error: cells of 0.001 mm are about"));
    EXPECT_TRUE(contains(text, "a run numbers 4.3e+09 at most\n"));
    EXPECT_TRUE(contains(text, "lengths are in mm; with these zones cells of 0.0"));
    EXPECT_TRUE(contains(text, "1 error"));
}

TEST_F(CaseError, criteria_are_refused)
{
    EXPECT_TRUE(contains(complaint(std::string(valid_case) + "[[refine.criterion]]\nfield = \"damage\"\n"),
                         "refinement by criteria is not in this version"));
}

TEST_F(CaseError, overrides)
{
    EXPECT_TRUE(contains(complaint(valid_case, {"grid.cel=0.5"}), "--set:1:6: error: unknown key 'cel' in [grid]\n"
                                                                  "    1 | grid.cel=0.5\n"
                                                                  "      |      ^~~  did you mean 'cell'?\n"));
    EXPECT_TRUE(contains(complaint(valid_case, {"grid.cell"}), "an override reads key=value"));
    EXPECT_TRUE(contains(complaint(valid_case, {"grid.cell=5 MPa"}), "'5 MPa' is a stress, but 'cell' is a length"));
    EXPECT_TRUE(contains(complaint(valid_case, {"refine.zone.3.level=1"}), "no item '3' here"));
    EXPECT_TRUE(contains(complaint(valid_case, {"output.checkpoint.every_wall=10 mm"}),
                         "expected wall time > 0 [s], such as \"20 min\"\n"));
}

TEST_F(CaseError, overrides_of_a_misspelt_name)
{
    EXPECT_EQ(complaint(valid_case, {"load.bse.velocity=2"}), "--set:1:6: error: there is no load 'bse'\n"
                                                              "    1 | load.bse.velocity=2\n"
                                                              "      |      ^~~  did you mean 'base'?\n"
                                                              "   loads here: pin, base; a new one needs more keys\n"
                                                              "1 error");
    EXPECT_TRUE(one_error(complaint(valid_case, {"material.stel.yield_stress=1100 MPa", "material.stel.density=1"}),
                          "--set:1:10: error: there is no material 'stel'\n"));
    EXPECT_TRUE(one_error(complaint(valid_case, {"feature.D.centre=[1, 2, 3]"}), "there is no feature 'D'\n"));
    // All of a new one is one, and one that is written as a whole says what it lacks.
    EXPECT_EQ(complaint(valid_case, {"feature.D.centre=[5, 5, 0]", "feature.D.diameter=1"}), "");
    EXPECT_TRUE(
        one_error(complaint(valid_case, {"feature.D={ centre = [5, 5, 0] }"}), "either a shape or the diameter"));
}
} // namespace
