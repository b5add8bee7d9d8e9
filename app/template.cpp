#include "app/template.h"

#include "io/document.h"
#include "io/keys.h"

#include <fmt/format.h>

#include <string_view>

namespace app
{
namespace
{
constexpr std::string_view bar =
    R"(# A sheet with a notch, pulled apart: change the shapes, materials and loads to yours.
#
#   cleave check {0}.toml     errors, cost, map of the levels
#   cleave run {0}.toml       results in results/{0}
#
# Bare numbers are in mm, g, ms (so N, MPa, mJ); quoted values carry a unit: "195 GPa", "5 m/s", "20 min".
units = "mm-g-ms"
title = {1}

[grid]
cell = 0.5             # level 0
levels = 2             # 0.5 and 0.25 mm

# A named hole or notch; zones, bodies and ligaments refer to it. Without a shape it is a hole of `diameter` along z.
[feature.notch]
centre = [0, 0, 0]
diameter = 2
[feature.edge]
centre = [5, 0, 0]
shape = {{ half_space = {{ point = [5, 0, 0], normal = [-1, 0, 0] }} }}

# One half of the sheet (symmetry at z = 0): 10 mm wide, 20 mm long, 2 mm thick.
[[body]]
name = "sheet"
material = "steel"
shape = {{ difference = {{ from = {{ box = {{ lower = [-5, -10, 0], upper = [5, 10, 1] }} }}, holes = [ {{ feature = "notch" }} ] }} }}

[[symmetry]]
axis = "z"
at = 0

[material.steel]
density = "7.81e-3 g/mm^3"
youngs_modulus = "195 GPa"
poisson_ratio = 0.3
yield_stress = "1100 MPa"
tangent_modulus = "1150 MPa"
[material.steel.decohesion] # leave it out and nothing breaks
preset = "paper"
second_crack = true # else broken metal goes on bridging cracks that run askew

[[refine.zone]]
name = "around the hole"
shape = {{ feature = "notch" }}
margin = 1.5
level = 1

[load.top]
region = {{ box = {{ lower = [-inf, 9, -inf], upper = [inf, inf, inf] }} }}
velocity = "2.5 m/s"
axis = "y"
ramp = {{ kind = "smooth_step", time = "0.02 ms" }}
[load.bottom]
region = {{ box = {{ lower = [-inf, -inf, -inf], upper = [inf, -9, inf] }} }}
velocity = "-2.5 m/s"
axis = "y"
ramp = {{ kind = "smooth_step", time = "0.02 ms" }}

[forces]
upper = "top"
lower = "bottom"
[gauge.cod]
upper = [0, 5, 0]
lower = [0, -5, 0]

[[ligament]]
from = "notch"
to = "edge"
[crack]
start = ["notch"]

[end]
time = "0.4 ms"

[output]
history = {{ every_time = "1 us" }}
particles = {{ every_time = "0.05 ms" }}
vdb = {{ every_time = "0.05 ms" }}

)";
} // namespace

std::string case_template(const std::string& name)
{
    std::string text = fmt::format(bar, name, io::write_value(io::node(std::string_view(name))));
    text += "# ---- every key ----\n";
    for (const std::string& section : io::section_names()) {
        text += fmt::format("#\n# [{}]\n", section.empty() ? "top of the file" : section);
        for (const io::Key* key : io::keys_of(section)) {
            const bool has_default = key->presence == io::Presence::defaulted;
            text += fmt::format("#   {}{}: {}; {}\n", key->name, has_default ? fmt::format(" = {}", key->fallback) : "",
                                io::expected(*key), key->meaning);
        }
    }
    return text;
}
} // namespace app
