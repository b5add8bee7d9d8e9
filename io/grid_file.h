/// Frames of the nested grid for ParaView: grid/g_NNNNNN.hdf (N = step) and the time table grid.hdf.series.
///
/// VTKHDF 1.0, static OverlappingAMR. The boxes of a level are cut from its cells that hold material, so nothing in the
/// file is empty. Coarse cells that finer ones fill are there too, with the mean of what lies in them, and are marked
/// as refined in vtkGhostType; those filled in part, at a surface, are only there as fine cells. VTK's reader makes its
/// own vtkGhostType from the boxes, which comes out the same; marks for empty cells would be lost in it
/// (vtkAMRUtilities::BlankCells).
///
/// The grid is that of the solver: in the total formulation it lies on the body at time 0, and `displacement` shows
/// where it has gone; in the updated formulation it lies on the body as it is. The attribute `configuration` outside
/// /VTKHDF says which: "rest" or "current".
/// Source: VTK file formats, VTKHDF 1.0, overlapping AMR.
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
inline constexpr NumberedFiles grid_files{"grid", "g_", 6, ".hdf", "grid.hdf.series"};

/// Names for `output.grid.fields`: density is mass over the volume of the cell, the others are means over the particles
/// at home in it, weighted by mass, with the units and components of io/particle_fields.h.
inline constexpr std::array<std::string_view, 7> grid_field_names{
    "density", "damage", "eq_plastic_strain", "von_mises", "stress", "velocity", "displacement"};

struct GridFileOptions
{
    std::vector<std::string> fields = {}; // of grid_field_names
    std::string version = {};
};

/// Write one frame into `directory` and enter it into the series file beside it. Values are stored in single precision.
///
/// @pre every name of options.fields is in grid_field_names; there are particles
/// @return path of the frame
/// @error FileError; the series then still lists complete frames only
std::filesystem::path write_grid_frame(const std::filesystem::path& directory, const particles::Particles& particles,
                                       const grid::Levels& levels, const solver::Clock& clock,
                                       const GridFileOptions& options);
} // namespace io
