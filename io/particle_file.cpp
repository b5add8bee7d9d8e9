#include "io/particle_file.h"

#include "core/contract.h"
#include "io/hdf5.h"
#include "io/particle_columns.h"
#include "io/particle_fields.h"
#include "io/vtkhdf_series.h"

#include <numeric>

namespace io
{
namespace
{
constexpr std::uint8_t vtk_vertex = 1; // VTK cell type

template <class T>
void write_fields(const particles::Particles& particles, const grid::Levels& levels, const ParticleFileOptions& options,
                  Hdf5Writer& file)
{
    const auto cast = [](const std::vector<Real>& values) { return std::vector<T>(values.begin(), values.end()); };
    file.dataset<T>("/VTKHDF/Points", cast(particle_points(particles)), 3);
    for (const std::string& name : options.fields) {
        const ParticleField* field = find_particle_field(name);
        CLEAVE_EXPECTS(field != nullptr);
        const std::string path = "/VTKHDF/PointData/" + name;
        const std::vector<Real> values = particle_column(*field, particles, levels);
        if (field->integer)
            file.dataset<std::int32_t>(path, std::vector<std::int32_t>(values.begin(), values.end()));
        else
            file.dataset<T>(path, cast(values), field->components);
        file.attribute(path, "units", field->unit);
    }
}

/// One vertex per particle. Connectivity 0, 1, 2, ... compresses to almost nothing.
void write_cells(std::int64_t count, Hdf5Writer& file)
{
    std::vector<std::int64_t> index(static_cast<std::size_t>(count) + 1);
    std::iota(index.begin(), index.end(), std::int64_t(0));
    const std::span<const std::int64_t> offsets(index);
    for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
        file.dataset<std::int64_t>(std::string("/VTKHDF/") + name, std::span(&count, 1));
    file.dataset<std::int64_t>("/VTKHDF/Connectivity", offsets.first(index.size() - 1));
    file.dataset<std::int64_t>("/VTKHDF/Offsets", offsets);
    file.dataset<std::uint8_t>("/VTKHDF/Types", std::vector<std::uint8_t>(index.size() - 1, vtk_vertex));
}
} // namespace

std::filesystem::path write_particle_frame(const std::filesystem::path& directory,
                                           const particles::Particles& particles, const grid::Levels& levels,
                                           const solver::Clock& clock, const ParticleFileOptions& options)
{
    make_directory(directory);
    const std::string name = particle_files.name(clock.step);
    Hdf5Writer file(directory / name);
    write_vtkhdf_head(clock, options.version, "UnstructuredGrid", file);
    const std::vector<Real> side = particle_sides(particles, levels, options.particles_per_cell);
    file.dataset<float>("/particle_side", std::vector<float>(side.begin(), side.end()));
    file.group("/VTKHDF/PointData");
    write_cells(static_cast<std::int64_t>(particles.size()), file);
    if (options.precision == Precision::f32)
        write_fields<float>(particles, levels, options, file);
    else
        write_fields<double>(particles, levels, options, file);
    file.commit();

    enter_frame(directory / particle_files.list, {name, clock.time});
    return directory / name;
}

std::optional<ParticleFrame> read_last_particle_frame(const std::filesystem::path& directory,
                                                      const std::vector<std::string>& fields)
{
    const std::vector<SeriesEntry> entries = read_series(directory / particle_files.list);
    if (entries.empty()) return {};
    const Hdf5Reader file(directory / entries.back().name);
    ParticleFrame frame;
    frame.time = file.attribute<double>("/", "time").at(0);
    frame.step = file.attribute<std::int64_t>("/", "step").at(0);
    const std::vector<float> points = file.dataset<float>("/VTKHDF/Points");
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t i = axis; i < points.size(); i += 3) frame.position[axis].push_back(points[i]);
    frame.side = file.dataset<float>("/particle_side");
    for (const std::string& name : fields)
        if (const std::string path = "/VTKHDF/PointData/" + name; file.exists(path))
            frame.scalar[name] = file.dataset<float>(path);
    return frame;
}
} // namespace io
