#include "io/grid_file.h"

#include "core/contract.h"
#include "io/cell_boxes.h"
#include "io/grid_cells.h"
#include "io/hdf5.h"
#include "io/particle_columns.h"
#include "io/particle_fields.h"
#include "io/vtkhdf_series.h"

#include <fmt/format.h>

#include <cstdint>
#include <limits>

namespace io
{
namespace
{
constexpr std::uint8_t vtk_refined_cell = 8; // vtkDataSetAttributes::REFINEDCELL

std::string group_of(std::size_t level)
{
    return fmt::format("/VTKHDF/Level{}", level);
}

/// Where the boxes of all levels count from, in cells of level 0: with it no index is negative.
Index3 first_cell(const std::vector<GridCells>& cells)
{
    Index3 first = Index3::Constant(std::numeric_limits<int>::max());
    for (std::size_t l = 0; l < cells.size(); ++l)
        for (const Index3& place : cells[l].place)
            first = first.cwiseMin(Index3(place.x() >> l, place.y() >> l, place.z() >> l));
    return first;
}

void write_boxes(const std::vector<CellBox>& boxes, const Index3& first, const std::string& group, Hdf5Writer& file)
{
    std::vector<std::int32_t> rows;
    for (const CellBox& box : boxes)
        for (int a = 0; a < 3; ++a) {
            rows.push_back(box.lower[a] - first[a]);
            rows.push_back(box.upper[a] - first[a]);
        }
    file.dataset<std::int32_t>(group + "/AMRBox", rows, 6);
}

/// Boxes of one level: first what fills coarser cells, cut along the edges of those, then the rest.
///
/// VTK sees that two boxes overlap only if they share two fine cells or more in every direction
/// (vtkAMRBox::DoesIntersect), and does not hide the coarse cells otherwise. With this cut they share an even number,
/// or none.
std::vector<CellBox> boxes_of(const GridCells& cells, const GridCells* coarser)
{
    std::vector<Index3> filled, rest;
    for (std::size_t c = 0; coarser && c < coarser->place.size(); ++c)
        if (coarser->covered[c] != 0) filled.push_back(coarser->place[c]);
    for (std::size_t c = 0; c < cells.place.size(); ++c)
        if (cells.parent.empty() || cells.parent[c] < 0) rest.push_back(cells.place[c]);
    std::vector<CellBox> boxes = cut_into_boxes(filled);
    for (CellBox& box : boxes) box = {2 * box.lower, 2 * box.upper + Index3::Ones()};
    const std::vector<CellBox> others = cut_into_boxes(rest);
    boxes.insert(boxes.end(), others.begin(), others.end());
    return boxes;
}

/// Groups, boxes and marks of one level.
/// @return the order in which it stores its cells
std::vector<std::size_t> write_level(const std::vector<GridCells>& all, std::size_t level, Real spacing,
                                     const Index3& first, Hdf5Writer& file)
{
    const GridCells& cells = all[level];
    const std::string group = group_of(level);
    file.group(group);
    const std::array<double, 3> edges{spacing, spacing, spacing};
    file.attribute<double>(group, "Spacing", std::span(edges));
    for (const char* name : {"/PointData", "/CellData", "/FieldData"}) file.group(group + name);
    const std::vector<CellBox> boxes = boxes_of(cells, level > 0 ? &all[level - 1] : nullptr);
    write_boxes(boxes, first, group, file);
    std::vector<std::size_t> order = box_order(cells.place, boxes);
    std::vector<std::uint8_t> ghost;
    ghost.reserve(order.size());
    for (const std::size_t c : order) ghost.push_back(cells.covered[c] != 0 ? vtk_refined_cell : 0);
    file.dataset<std::uint8_t>(group + "/CellData/vtkGhostType", ghost);
    return order;
}

/// One field of one level: sums over the sums of the weights.
void write_field(const std::string& path, std::string_view unit, int components, const std::vector<std::size_t>& order,
                 const std::vector<Real>& sums, const std::vector<Real>& weights, Hdf5Writer& file)
{
    const auto width = static_cast<std::size_t>(components);
    std::vector<float> rows;
    rows.reserve(sums.size());
    for (const std::size_t c : order)
        for (std::size_t i = 0; i < width; ++i) rows.push_back(static_cast<float>(sums[c * width + i] / weights[c]));
    file.dataset<float>(path, rows, components);
    file.attribute(path, "units", unit);
}

void write_fields(const particles::Particles& particles, const grid::Levels& levels, const GridFileOptions& options,
                  const std::vector<GridCells>& cells, const std::vector<std::vector<std::size_t>>& order,
                  Hdf5Writer& file)
{
    const std::vector<std::vector<Real>> mass = sum_over_cells(cells, particles.mass);
    for (const std::string& name : options.fields) {
        const ParticleField* field = find_particle_field(name);
        CLEAVE_EXPECTS(field != nullptr || name == "density");
        const int components = field ? field->components : 1;
        const auto sums =
            field ? sum_over_cells(cells, particles.mass, particle_column(*field, particles, levels), components)
                  : mass;
        for (std::size_t l = 0; l < cells.size(); ++l) {
            const Real h = levels.spacing(static_cast<int>(l));
            const std::vector<Real> weights = field ? mass[l] : std::vector<Real>(mass[l].size(), h * h * h);
            write_field(group_of(l) + "/CellData/" + name, field ? field->unit : "g/mm^3", components, order[l],
                        sums[l], weights, file);
        }
    }
}
} // namespace

std::filesystem::path write_grid_frame(const std::filesystem::path& directory, const particles::Particles& particles,
                                       const grid::Levels& levels, const solver::Clock& clock,
                                       const GridFileOptions& options)
{
    make_directory(directory);
    const std::string name = grid_files.name(clock.step);
    const std::vector<GridCells> cells = grid_cells(levels);
    const Index3 first = first_cell(cells);
    const Vec3 corner = levels.origin + first.cast<Real>() * levels.spacing0;
    const std::array<double, 3> origin{corner.x(), corner.y(), corner.z()};

    Hdf5Writer file(directory / name);
    write_vtkhdf_head(clock, options.version, "OverlappingAMR", file);
    const bool total = !particles.deformation_gradient[0].empty();
    file.attribute("/", "configuration", std::string_view(total ? "rest" : "current"));
    file.attribute("/VTKHDF", "GridDescription", std::string_view("XYZ"));
    file.attribute<double>("/VTKHDF", "Origin", std::span(origin));
    std::vector<std::vector<std::size_t>> order;
    for (std::size_t l = 0; l < cells.size(); ++l)
        order.push_back(write_level(cells, l, levels.spacing(static_cast<int>(l)), first * (1 << l), file));
    write_fields(particles, levels, options, cells, order, file);
    file.commit();

    enter_frame(directory / grid_files.list, {name, clock.time});
    return directory / name;
}
} // namespace io
