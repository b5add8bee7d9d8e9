/// Volumes for Blender and Houdini: vdb/vol_NNNN.vdb, one sparse grid per quantity at the finest spacing.
///
/// Every particle is a cube of its side at its current place; a voxel gets the share of the particle's mass that the
/// overlap of cube and voxel gives. So the integral of `density` is the mass of the body, and coarse regions come out
/// as filled blocks. The other quantities are means weighted by those masses. Values are cell data: the voxel (i, j, k)
/// is centred at origin + (i + 1/2, j + 1/2, k + 1/2) h. Only float and vec3s grids, because Debian's Python module
/// refuses a file with anything else.
#pragma once

#include "grid/levels.h"
#include "io/numbered_files.h"
#include "particles/particles.h"
#include "solver/state.h"

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace io
{
inline constexpr NumberedFiles vdb_files{"vdb", "vol_", 4, ".vdb", ""};

/// Names for `output.vdb.grids`.
inline constexpr std::array<std::string_view, 4> vdb_grid_names{"density", "damage", "eq_plastic_strain", "velocity"};
/// Names for `output.vdb.preset`: houdini renames velocity to vel.
inline constexpr std::array<std::string_view, 2> vdb_presets{"blender", "houdini"};

struct VdbFileOptions
{
    std::vector<std::string> grids = {}; // of vdb_grid_names: g/mm^3, 1, 1, mm/ms
    std::string preset = "blender";
    Real scale = 1;             // scene units per mm
    int particles_per_cell = 8; // 1, fixes the side of a particle
    std::string version = {};
};

/// Write vol_NNNN.vdb into `directory`; values are stored as half floats.
///
/// @param frame  N, counted from 1 without gaps, as importers of sequences want it
/// @return path of the file
/// @error FileError
std::filesystem::path write_vdb_frame(const std::filesystem::path& directory, int frame,
                                      const particles::Particles& particles, const grid::Levels& levels,
                                      const solver::Clock& clock, const VdbFileOptions& options);

struct VdbFrame
{
    int number = 0; // 0: there is none
    std::int64_t step = -1;
};

/// The last frame written at or before `step`: a resumed run goes on with the next.
/// @error FileError if a frame cannot be read
VdbFrame last_vdb_frame(const std::filesystem::path& directory, std::int64_t step);
} // namespace io
