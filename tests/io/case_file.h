/// A small valid case, and a directory to write variants of it into.
#pragma once

#include "core/error.h"
#include "io/case.h"
#include "tests/support/folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace test
{
inline constexpr std::string_view valid_case = R"(units = "mm-g-ms"
[grid]
cell = 1
levels = 2
[material.steel]
density = "7.81e-3 g/mm^3"
youngs_modulus = "195 GPa"
poisson_ratio = 0.3
yield_stress = 1100
[material.steel.decohesion]
s_max = "4900 MPa"
tau_max = "820 MPa"
u0 = "2e-7 m"
[feature.A]
centre = [2, 5, 0]
diameter = 2
[feature.B]
centre = [8, 5, 0]
diameter = 3
[[body]]
name = "plate"
material = "steel"
shape = { difference = { from = { box = { lower = [0, 0, 0], upper = [10, 10, 2] } }, holes = [{ feature = "A" }, { feature = "B" }] } }
[[symmetry]]
axis = "z"
at = 0
[[refine.zone]]
name = "between"
shape = { polyline = ["A", "B"], radius = 1.5 }
level = 1
[load.pin]
pin = { feature = "A" }
velocity = [0, "2 m/s", "free"]
ramp = { time = "50 us" }
[load.base]
region = { box = { lower = [-1, -1, -1], upper = [11, 1, 3] } }
velocity = 0
axis = "y"
[gauge.cod]
upper = [5, 6, 0]
lower = [5, 4, 0]
[forces]
upper = "pin"
lower = "base"
[[ligament]]
from = "A"
to = "B"
[crack]
start = ["A"]
[end]
cod = 3
)";

/// `text` with the first `from` replaced; fails the test if it is not there.
inline std::string with(std::string_view text, std::string_view from, std::string_view to)
{
    std::string out(text);
    const std::size_t at = out.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) out.replace(at, from.size(), to);
    return out;
}

class CaseFile : public testing::Test
{
protected:
    std::filesystem::path write(std::string_view text, const std::string& name = "case.toml") const
    {
        const std::filesystem::path file = directory_ / name;
        std::ofstream(file) << text;
        return file;
    }

    /// The complaint about a case text, with the directory taken out.
    std::string complaint(std::string_view text, const std::vector<std::string>& overrides = {}) const
    {
        try {
            (void)io::read_case(write(text), overrides);
        } catch (const core::InputError& error) {
            std::string out = error.what();
            const std::string prefix = directory().string() + "/";
            for (std::size_t at = out.find(prefix); at != std::string::npos; at = out.find(prefix))
                out.erase(at, prefix.size());
            return out;
        }
        return "";
    }

    const std::filesystem::path& directory() const { return directory_.path(); }

private:
    support::Folder directory_;
};
} // namespace test
