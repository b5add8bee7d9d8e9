#include "solver/ligaments.h"

#include "core/contract.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace solver
{
namespace
{
const Feature& feature_named(const Problem& problem, const std::string& name)
{
    const auto found = std::find_if(problem.features.begin(), problem.features.end(),
                                    [&](const Feature& feature) { return feature.name == name; });
    CLEAVE_EXPECTS(found != problem.features.end());
    return *found;
}

LigamentColumns columns_of(const Problem& problem, const Ligament& ligament)
{
    CLEAVE_EXPECTS(ligament.corridor.size() >= 3);
    const Feature& from = feature_named(problem, ligament.from);
    const Feature& to = feature_named(problem, ligament.to);

    LigamentColumns columns;
    columns.axis_u = (ligament.through + 1) % 3;
    columns.axis_v = (ligament.through + 2) % 3;
    columns.axis_w = ligament.through;
    const Real h = columns.spacing = problem.grid.cell / static_cast<Real>(1 << (problem.grid.levels - 1));
    std::array<Real, 2> lower = ligament.corridor[0], upper = lower;
    for (const auto& corner : ligament.corridor)
        for (std::size_t i = 0; i < 2; ++i) {
            lower[i] = std::min(lower[i], corner[i]);
            upper[i] = std::max(upper[i], corner[i]);
        }
    const std::array<Real, 2> origin{problem.grid.origin[columns.axis_u], problem.grid.origin[columns.axis_v]};
    std::array<int, 2> count{};
    for (std::size_t i = 0; i < 2; ++i) {
        lower[i] = origin[i] + h * std::floor((lower[i] - origin[i]) / h);
        count[i] = static_cast<int>(std::ceil((upper[i] - lower[i]) / h));
    }
    columns.lower_u = lower[0];
    columns.lower_v = lower[1];
    columns.origin_w = problem.grid.origin[columns.axis_w];
    columns.count_u = count[0];
    columns.count_v = count[1];

    const geometry::Shape corridor = geometry::extruded_polygon(ligament.corridor, ligament.through, -1, 1);
    Vec3 along = to.centre - from.centre;
    along[ligament.through] = 0;
    if (along.norm() > 0) along.normalize();
    for (int u = 0; u < count[0]; ++u)
        for (int v = 0; v < count[1]; ++v) {
            Vec3 centre = Vec3::Zero();
            centre[columns.axis_u] = lower[0] + (u + 0.5) * h;
            centre[columns.axis_v] = lower[1] + (v + 0.5) * h;
            columns.inside.push_back(corridor.contains(centre));
            const auto touches = [&](const Feature& feature) {
                centre[ligament.through] = feature.centre[ligament.through];
                return feature.shape.distance(centre) <= touching_distance * h;
            };
            columns.touches_from.push_back(touches(from));
            columns.touches_to.push_back(touches(to));
            columns.station.push_back(static_cast<std::int32_t>(std::floor(along.dot(centre - from.centre) / h)));
        }
    return columns;
}

/// Contents of one ligament's cells at one time.
struct Contents
{
    std::vector<Real> separated; // mm^3, as LigamentColumns::cell_volume, of the particles with damage 1
    bool damaged = false;        // some particle has damage > 0
    bool any_separated = false;  // some particle has damage 1
};

/// Particles with decohesion state, ascending.
std::vector<std::uint32_t> cracked(const particles::Particles& particles)
{
    std::vector<std::uint32_t> places;
    if (particles.cracks.empty()) return places;
    for (std::uint32_t p = 0; p < particles.size(); ++p)
        if (particles.crack[p] >= 0) places.push_back(p);
    return places;
}

std::int32_t column_of(const LigamentColumns& columns, const particles::Particles& particles, std::size_t p)
{
    return columns.column(particles.rest_position[static_cast<std::size_t>(columns.axis_u)][p],
                          particles.rest_position[static_cast<std::size_t>(columns.axis_v)][p]);
}

Real across(const LigamentColumns& columns, const particles::Particles& particles, std::size_t p)
{
    return particles.rest_position[static_cast<std::size_t>(columns.axis_w)][p];
}

/// @param places  particles with decohesion state: nobody else is looked at
Contents contents_of(const LigamentColumns& columns, const particles::Particles& particles,
                     const std::vector<std::uint32_t>& places)
{
    Contents contents;
    contents.separated.assign(columns.cell_volume.size(), 0);
    for (const std::uint32_t p : places) {
        const std::int32_t column = column_of(columns, particles, p);
        if (column < 0) continue;
        const Real damage = particles.cracks[static_cast<std::size_t>(particles.crack[p])].damage;
        contents.damaged = contents.damaged || damage > 0;
        if (damage < 1) continue;
        contents.separated[columns.cell(column, across(columns, particles, p))] += particles.rest_volume[p];
        contents.any_separated = true;
    }
    return contents;
}

/// 1 where at least `broken_share` of the volume is separated; of columns or of cells.
std::vector<std::uint8_t> broken_ones(const std::vector<Real>& separated, const std::vector<Real>& volume)
{
    std::vector<std::uint8_t> broken(volume.size());
    for (std::size_t c = 0; c < broken.size(); ++c)
        broken[c] = separated[c] > 0 && separated[c] >= broken_share * volume[c];
    return broken;
}

/// Sums over the layers, by column.
std::vector<Real> column_sums(const LigamentColumns& columns, const std::vector<Real>& cells)
{
    std::vector<Real> sums(columns.inside.size());
    for (std::size_t c = 0; c < cells.size(); ++c) sums[c % sums.size()] += cells[c];
    return sums;
}

/// Whether broken columns, or cells of one layer, joined by sides or corners, lead from one feature to the other.
bool joins(const LigamentColumns& columns, std::span<const std::uint8_t> broken)
{
    std::vector<std::int32_t> front;
    std::vector<std::uint8_t> seen(broken.size());
    const auto visit = [&](int u, int v) {
        if (u < 0 || v < 0 || u >= columns.count_u || v >= columns.count_v) return;
        const std::int32_t column = u * columns.count_v + v;
        const auto c = static_cast<std::size_t>(column);
        if (!broken[c] || seen[c]) return;
        seen[c] = 1;
        front.push_back(column);
    };
    for (int u = 0; u < columns.count_u; ++u)
        for (int v = 0; v < columns.count_v; ++v)
            if (columns.touches_from[static_cast<std::size_t>(u * columns.count_v + v)]) visit(u, v);
    while (!front.empty()) {
        const std::int32_t column = front.back();
        front.pop_back();
        if (columns.touches_to[static_cast<std::size_t>(column)]) return true;
        const int u = column / columns.count_v, v = column % columns.count_v;
        for (int du = -1; du <= 1; ++du)
            for (int dv = -1; dv <= 1; ++dv) visit(u + du, v + dv);
    }
    return false;
}

/// Whether broken cells lead from one feature to the other in enough of the layers.
bool joins_in_layers(const LigamentColumns& columns, const Contents& contents)
{
    const std::vector<std::uint8_t> cells = broken_ones(contents.separated, columns.cell_volume);
    const std::size_t count = columns.inside.size();
    int joined = 0;
    for (int layer = 0; layer < columns.layers; ++layer)
        joined += joins(columns, std::span(cells).subspan(static_cast<std::size_t>(layer) * count, count));
    return joined >= broken_share * columns.layers;
}

/// Share of the stations with material that have a broken column.
Real broken_front(const LigamentColumns& columns, const std::vector<std::uint8_t>& broken)
{
    if (columns.station.empty()) return 0;
    const auto [first, last] = std::minmax_element(columns.station.begin(), columns.station.end());
    std::vector<std::uint8_t> station(static_cast<std::size_t>(*last - *first + 1)); // 0 empty, 1 material, 2 broken
    for (std::size_t c = 0; c < broken.size(); ++c) {
        std::uint8_t& value = station[static_cast<std::size_t>(columns.station[c] - *first)];
        if (broken[c])
            value = 2;
        else if (columns.volume[c] > 0)
            value = std::max<std::uint8_t>(value, 1);
    }
    const auto material = std::count_if(station.begin(), station.end(), [](std::uint8_t s) { return s > 0; });
    const auto cut = std::count(station.begin(), station.end(), 2);
    return material > 0 ? static_cast<Real>(cut) / static_cast<Real>(material) : 0;
}

void note(const Observation& now, Real& time, Real& force, Real& cod)
{
    if (time >= 0) return;
    time = now.time;
    force = now.force;
    cod = now.cod;
}
} // namespace

std::int32_t LigamentColumns::column(Real u, Real v) const
{
    const Real x = (u - lower_u) / spacing, y = (v - lower_v) / spacing;
    if (!(x >= 0 && y >= 0 && x < count_u && y < count_v)) return -1;
    const std::int32_t c = static_cast<std::int32_t>(x) * count_v + static_cast<std::int32_t>(y);
    return inside[static_cast<std::size_t>(c)] ? c : -1;
}

std::size_t LigamentColumns::cell(std::int32_t column, Real w) const
{
    const auto layer = static_cast<std::size_t>(std::clamp(static_cast<int>((w - lower_w) / spacing), 0, layers - 1));
    return layer * inside.size() + static_cast<std::size_t>(column);
}

LigamentMap ligament_map(const Problem& problem)
{
    LigamentMap map;
    for (const Ligament& ligament : problem.ligaments) map.ligaments.push_back(columns_of(problem, ligament));
    return map;
}

void weigh_columns(const particles::Particles& particles, LigamentMap& map)
{
    core::parallel_for(map.ligaments.size(), [&](std::size_t i) {
        LigamentColumns& columns = map.ligaments[i];
        Real lowest = std::numeric_limits<Real>::infinity(), highest = -lowest;
        for (std::size_t p = 0; p < particles.size(); ++p) {
            if (column_of(columns, particles, p) < 0) continue;
            lowest = std::min(lowest, across(columns, particles, p));
            highest = std::max(highest, across(columns, particles, p));
        }
        columns.layers = 0;
        if (lowest <= highest) {
            const Real h = columns.spacing;
            columns.lower_w = columns.origin_w + h * std::floor((lowest - columns.origin_w) / h);
            columns.layers = static_cast<int>((highest - columns.lower_w) / h) + 1;
        }
        columns.cell_volume.assign(static_cast<std::size_t>(columns.layers) * columns.inside.size(), 0);
        for (std::size_t p = 0; p < particles.size(); ++p) {
            const std::int32_t column = column_of(columns, particles, p);
            if (column < 0) continue;
            columns.cell_volume[columns.cell(column, across(columns, particles, p))] += particles.rest_volume[p];
        }
        columns.volume = column_sums(columns, columns.cell_volume);
    });
}

void update_ligaments(const LigamentMap& map, const particles::Particles& particles, const Observation& now,
                      std::vector<LigamentState>& ligaments)
{
    if (ligaments.empty()) ligaments.resize(map.ligaments.size());
    CLEAVE_EXPECTS(ligaments.size() == map.ligaments.size());
    const std::vector<std::uint32_t> places = cracked(particles);
    if (places.empty()) return;
    for (std::size_t i = 0; i < ligaments.size(); ++i) {
        const LigamentColumns& columns = map.ligaments[i];
        LigamentState& state = ligaments[i];
        CLEAVE_EXPECTS(columns.volume.size() == columns.inside.size());
        const Contents contents = contents_of(columns, particles, places);
        if (!contents.damaged) continue;
        note(now, state.onset_time, state.onset_force, state.onset_cod);
        if (!contents.any_separated) continue;
        const std::vector<std::uint8_t> broken = broken_ones(column_sums(columns, contents.separated), columns.volume);
        const bool through = state.through_time >= 0 || joins(columns, broken) || joins_in_layers(columns, contents);
        if (!through && std::find(broken.begin(), broken.end(), 1) == broken.end()) continue;
        note(now, state.first_time, state.first_force, state.first_cod);
        state.front = broken_front(columns, broken);
        if (through) note(now, state.through_time, state.through_force, state.through_cod);
    }
}

CrackPath crack_path(const std::vector<Ligament>& names, const std::vector<LigamentState>& states,
                     const std::vector<std::string>& start_features)
{
    CLEAVE_EXPECTS(names.size() == states.size());
    CrackPath path;
    std::vector<std::string> ends = start_features; // where the next ligament may begin
    while (true) {
        const std::size_t none = names.size();
        std::size_t next = none;
        bool forward = true;
        Real earliest = std::numeric_limits<Real>::infinity();
        const auto visited = [&](const std::string& name) {
            return std::find(path.features.begin(), path.features.end(), name) != path.features.end();
        };
        for (std::size_t i = 0; i < names.size(); ++i)
            for (const std::string& end : ends) {
                const bool from_here = names[i].from == end, to_here = names[i].to == end;
                if (!from_here && !to_here) continue;
                const Real time = states[i].through_time;
                if (time < 0 || time >= earliest || visited(from_here ? names[i].to : names[i].from)) continue;
                next = i;
                forward = from_here;
                earliest = time;
            }
        if (next == none) return path;
        const Ligament& ligament = names[next];
        if (path.features.empty()) path.features.push_back(forward ? ligament.from : ligament.to);
        path.features.push_back(forward ? ligament.to : ligament.from);
        path.ligaments.push_back(next);
        ends = {path.features.back()};
    }
}

std::string path_name(const CrackPath& path)
{
    std::string name;
    for (const std::string& feature : path.features) name += (name.empty() ? "" : "-") + feature;
    return name;
}
} // namespace solver
