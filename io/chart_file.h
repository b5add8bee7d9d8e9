/// The table of `cleave chart`: one row per scene and setting, as CSV.
#pragma once

#include "core/real.h"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace io
{
struct ChartRow
{
    static constexpr Real none = std::numeric_limits<Real>::quiet_NaN();

    std::string scene, file; // name of the scene, its case
    std::string setting;     // labels of all axes
    std::string scheme;      // labels of the axes that are not resolution
    std::string role;        // "default": the case as it is; "scheme": the same scheme in another resolution; or empty
    std::string status;      // done, unstable, failed, over limit, not reached, not applicable, pending
    Real exit_code = none;   // minus the signal if one ended it
    Real error = none;       // 1, relative
    Real stability = none;   // the number of the stability criterion
    Real cpu_s = none, wall_s = none;
    Real steps = none, particle_steps = none, peak_rss_bytes = none, particles = none; // particles at time 0
    Real cell_mm = none, finest_mm = none; // spacing of level 0, of the finest
    Real levels = none, particles_per_cell = none;
    std::string formulation, basis, transfer, stress_update, precision;
    Real pic_fraction = none, cfl = none;
    Real length_mm = none;                                                     // what the cells have to resolve
    Real contact = 0, large_motion = 0, plastic = 0, crack = 0, localised = 0; // 0 or 1, features of the scene
    Real front = 0;                                                            // 1: on the Pareto front
    Real cost_over_front = none; // cpu_s over the smallest of a run of the scene with no larger error
    std::string version;
    std::string overrides; // of the setting, separated by "; "
    std::string reason;    // why it is not done
};

/// @error FileError
void write_chart(const std::filesystem::path& path, const std::vector<ChartRow>& rows);

/// @error FileError if the file is missing or holds something else
std::vector<ChartRow> read_chart(const std::filesystem::path& path);
} // namespace io
