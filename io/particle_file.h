/// Particle frames for ParaView: particles/p_NNNNNN.hdf (N = step) and the time table particles.hdf.series.
///
/// VTKHDF 1.0, static UnstructuredGrid of vertices: the one form ParaView 5.11 reads correctly. Fields are those of
/// io/particle_fields.h. Outside /VTKHDF the file has the attributes time [ms], step, units, version and the dataset
/// /particle_side [p] mm: the edge of the cube a particle stands for.
/// Source: VTK file formats, VTKHDF 1.0.
#pragma once

#include "grid/levels.h"
#include "io/numbered_files.h"
#include "particles/particles.h"
#include "solver/state.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace io
{
inline constexpr NumberedFiles particle_files{"particles", "p_", 6, ".hdf", "particles.hdf.series"};

enum class Precision
{
    f32,
    f64,
};

struct ParticleFileOptions
{
    std::vector<std::string> fields = {}; // names of particle_fields
    Precision precision = Precision::f32;
    int particles_per_cell = 8; // 1, fixes the side of a particle
    std::string version = {};
};

/// Write one frame into `directory` and enter it into the series file beside it.
///
/// @pre every name of options.fields is in particle_fields
/// @return path of the frame
/// @error FileError; the series then still lists complete frames only
std::filesystem::path write_particle_frame(const std::filesystem::path& directory,
                                           const particles::Particles& particles, const grid::Levels& levels,
                                           const solver::Clock& clock, const ParticleFileOptions& options);

/// One frame as the report needs it.
struct ParticleFrame
{
    Real time = 0;                                    // ms
    std::int64_t step = 0;                            // 1
    std::array<std::vector<float>, 3> position;       // [p] mm
    std::vector<float> side;                          // [p] mm
    std::map<std::string, std::vector<float>> scalar; // [field][p], of the asked fields those that are there
};

/// The last frame of the series, empty if there is none.
/// @param fields  scalar fields to read
/// @error FileError
std::optional<ParticleFrame> read_last_particle_frame(const std::filesystem::path& directory,
                                                      const std::vector<std::string>& fields);
} // namespace io
