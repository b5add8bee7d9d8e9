/// What the VTKHDF files of a run have in common: their head, and the table of frames with times that ParaView opens.
///
/// The table is a .hdf.series file beside the frames, rewritten through a temporary name after every frame, so that it
/// lists complete frames only and the results of a running case can be opened.
#pragma once

#include "io/hdf5.h"
#include "solver/state.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace io
{
/// Version [major, minor] of the VTKHDF format: static files, which ParaView 5.11 and later read.
inline constexpr std::array<std::int64_t, 2> vtkhdf_version{1, 0};

/// Write the attributes time [ms], step, units and version of the file, and the group /VTKHDF with its own.
/// @param type  of the data set, such as "UnstructuredGrid"
void write_vtkhdf_head(const solver::Clock& clock, std::string_view program_version, std::string_view type,
                       Hdf5Writer& file);

struct SeriesEntry
{
    std::string name; // file beside the series
    Real time;        // ms
};

/// Frames of a series in order of time, none if there is no such file.
/// @error FileError
std::vector<SeriesEntry> read_series(const std::filesystem::path& path);

/// Enter a frame in order of time; one of the same name is replaced.
/// @error FileError
void enter_frame(const std::filesystem::path& path, const SeriesEntry& entry);

/// Drop the frames later than `time` [ms], so that a resumed run enters them again. Without the file: nothing.
/// @error FileError
void rewind_series(const std::filesystem::path& path, Real time);
} // namespace io
