#include "io/checkpoint_state.h"

#include "core/error.h"
#include "io/state_columns.h"

#include <algorithm>
#include <type_traits>

namespace io
{
namespace
{
template <class T, class Allocator>
void store(const std::string& path, const std::vector<T, Allocator>& values, int columns, Hdf5Writer& file)
{
    file.dataset<T>(path, values, columns, Hdf5Filter::checksum);
}

/// A row of a table taken apart: its reals and its integers, each in the order of visit_members.
struct Parts
{
    std::vector<Real> reals;
    std::vector<std::int64_t> integers;
    std::string names; // of all members, to recognise another layout
};

template <class Row>
void take_apart(Row& row, Parts& parts)
{
    visit_members(row, [&](const std::string&, auto& member) {
        if constexpr (std::is_same_v<decltype(member), Real&>)
            parts.reals.push_back(member);
        else
            parts.integers.push_back(static_cast<std::int64_t>(member));
    });
}

/// Number and names of the members of a Row.
template <class Row>
Parts layout()
{
    Row row{};
    Parts parts;
    take_apart(row, parts);
    visit_members(row, [&](const std::string& name, auto&) { parts.names += (parts.names.empty() ? "" : ",") + name; });
    return parts;
}

/// A vector of structs as a group with the table of its real and that of its integer members.
template <class Row>
void store_rows(const std::string& group, std::vector<Row> rows, Hdf5Writer& file)
{
    const Parts members = layout<Row>();
    Parts parts;
    for (Row& row : rows) take_apart(row, parts);
    file.group(group);
    file.attribute(group, "members", std::string_view(members.names));
    file.attribute(group, "rows", static_cast<std::uint64_t>(rows.size()));
    store(group + "/reals", parts.reals, static_cast<int>(std::max<std::size_t>(1, members.reals.size())), file);
    store(group + "/integers", parts.integers, static_cast<int>(std::max<std::size_t>(1, members.integers.size())),
          file);
}

[[noreturn]] void damaged(const Hdf5Reader& file, const std::string& what)
{
    throw core::FileError("cannot read '" + file.path().string() + "': " + what);
}

template <class Row>
std::vector<Row> load_rows(const std::string& group, const Hdf5Reader& file)
{
    const Parts members = layout<Row>();
    if (file.text_attribute(group, "members") != members.names)
        damaged(file, "'" + group + "' has other members than this program");
    std::vector<Row> rows(file.attribute<std::uint64_t>(group, "rows").at(0));
    const auto reals = file.dataset<Real>(group + "/reals");
    const auto integers = file.dataset<std::int64_t>(group + "/integers");
    if (reals.size() != rows.size() * members.reals.size() || integers.size() != rows.size() * members.integers.size())
        damaged(file, "'" + group + "' has the wrong size");
    auto real = reals.begin();
    auto integer = integers.begin();
    for (Row& row : rows)
        visit_members(row, [&](const std::string&, auto& member) {
            if constexpr (std::is_same_v<decltype(member), Real&>)
                member = *real++;
            else
                member = static_cast<std::remove_reference_t<decltype(member)>>(*integer++);
        });
    return rows;
}

template <class Row>
Row load_row(const std::string& group, const Hdf5Reader& file)
{
    const std::vector<Row> rows = load_rows<Row>(group, file);
    if (rows.size() != 1) damaged(file, "'" + group + "' has not one row");
    return rows[0];
}

void store_particles(const particles::Particles& particles, Hdf5Writer& file)
{
    file.group("/particles");
    const auto store_column = [&](const std::string& name, const auto& column) {
        store("/particles/" + name, column, 1, file);
    };
    particles::Particles::for_each_real(particles, store_column);
    particles::Particles::for_each_integer(particles, store_column);
    store_rows("/cracks", particles.cracks, file);
}

particles::Particles load_particles(const Hdf5Reader& file)
{
    particles::Particles particles;
    const auto load_column = [&]<class T, class Allocator>(const std::string& name, std::vector<T, Allocator>& column) {
        const std::vector<T> stored = file.dataset<T>("/particles/" + name);
        column.assign(stored.begin(), stored.end());
    };
    particles::Particles::for_each_real(particles, load_column);
    particles::Particles::for_each_integer(particles, load_column);
    particles.cracks = load_rows<particles::Crack>("/cracks", file);

    const std::size_t count = particles.size();
    const auto check = [&](const std::string& name, const auto& column) {
        if (!column.empty() && column.size() != count) damaged(file, "column '" + name + "' has the wrong length");
    };
    particles::Particles::for_each_real(particles, check);
    particles::Particles::for_each_integer(particles, check);
    const auto cracks = static_cast<std::int32_t>(particles.cracks.size());
    if (std::any_of(particles.crack.begin(), particles.crack.end(), [&](std::int32_t c) { return c >= cracks; }))
        damaged(file, "a particle names a crack that is not there");
    return particles;
}

void store_levels(const grid::Levels& levels, Hdf5Writer& file)
{
    file.group("/levels");
    file.attribute("/levels", "spacing0", levels.spacing0);
    file.attribute("/levels", "count", static_cast<std::int64_t>(levels.count));
    file.attribute<Real>("/levels", "origin", std::span(levels.origin.data(), 3));
    std::vector<std::int32_t> leaves; // level, then origin
    for (const grid::Leaf& leaf : levels.leaves)
        leaves.insert(leaves.end(), {leaf.level, leaf.origin.x(), leaf.origin.y(), leaf.origin.z()});
    store("/levels/leaves", leaves, 4, file);
    store("/levels/level_start", levels.level_start, 1, file);
    store("/levels/cell_active", levels.cell_active, 1, file);
    store("/levels/cell_start", levels.cell_start, 1, file);
}

grid::Levels load_levels(std::size_t particles, const Hdf5Reader& file)
{
    grid::Levels levels;
    levels.spacing0 = file.attribute<Real>("/levels", "spacing0").at(0);
    levels.count = static_cast<int>(file.attribute<std::int64_t>("/levels", "count").at(0));
    const auto origin = file.attribute<Real>("/levels", "origin");
    if (origin.size() != 3) damaged(file, "the grid has no origin");
    levels.origin = Vec3(origin[0], origin[1], origin[2]);
    const auto leaves = file.dataset<std::int32_t>("/levels/leaves");
    for (std::size_t i = 0; i + 3 < leaves.size(); i += 4) {
        grid::Leaf& leaf = levels.leaves.emplace_back();
        leaf.level = leaves[i];
        leaf.origin = Index3(leaves[i + 1], leaves[i + 2], leaves[i + 3]);
        leaf.neighbour.fill(-1); // until the grid is rebuilt
    }
    levels.level_start = file.dataset<std::int32_t>("/levels/level_start");
    levels.cell_active = file.dataset<std::uint8_t>("/levels/cell_active");
    levels.cell_start = file.dataset<std::uint32_t>("/levels/cell_start");

    const std::size_t cells = levels.leaves.size() * grid::leaf_cells;
    const bool fits = levels.level_start.size() == static_cast<std::size_t>(levels.count) + 1 &&
                      static_cast<std::size_t>(levels.level_start.back()) == levels.leaves.size() &&
                      levels.cell_active.size() == cells && levels.cell_start.size() == cells + 1 &&
                      levels.cell_start.back() == particles;
    if (!fits) damaged(file, "the tables of the grid do not fit together");
    return levels;
}

/// The history, with the particle counts of all its lines as one table.
void store_history(const std::vector<solver::HistoryLine>& history, int levels, Hdf5Writer& file)
{
    std::vector<std::uint64_t> counts;
    for (const solver::HistoryLine& line : history)
        counts.insert(counts.end(), line.particles.begin(), line.particles.end());
    store_rows("/history", history, file);
    store("/history/particles", counts, levels, file);
}

std::vector<solver::HistoryLine> load_history(int levels, const Hdf5Reader& file)
{
    auto history = load_rows<solver::HistoryLine>("/history", file);
    const auto counts = file.dataset<std::uint64_t>("/history/particles");
    const auto width = static_cast<std::ptrdiff_t>(levels);
    if (counts.size() != history.size() * static_cast<std::size_t>(levels))
        damaged(file, "the history has the wrong number of particle counts");
    auto count = counts.begin();
    for (solver::HistoryLine& line : history) {
        line.particles.assign(count, count + width);
        count += width;
    }
    return history;
}

/// Samples of the measures: times as rows, values as one table.
void store_samples(const std::vector<solver::Sample>& samples, Hdf5Writer& file)
{
    std::vector<Real> time, value;
    std::vector<std::int64_t> step;
    for (const solver::Sample& sample : samples) {
        step.push_back(sample.step);
        time.push_back(sample.time);
        value.insert(value.end(), sample.value.begin(), sample.value.end());
    }
    file.group("/samples");
    store("/samples/step", step, 1, file);
    store("/samples/time", time, 1, file);
    store("/samples/value", value, samples.empty() ? 1 : std::max(1, static_cast<int>(samples[0].value.size())), file);
}

std::vector<solver::Sample> load_samples(const Hdf5Reader& file)
{
    const auto step = file.dataset<std::int64_t>("/samples/step");
    const auto time = file.dataset<Real>("/samples/time");
    const auto value = file.dataset<Real>("/samples/value");
    if (time.size() != step.size() || (step.empty() ? !value.empty() : value.size() % step.size() != 0))
        damaged(file, "the samples of the measures do not fit together");
    std::vector<solver::Sample> samples(step.size());
    const std::size_t width = step.empty() ? 0 : value.size() / step.size();
    for (std::size_t n = 0; n < samples.size(); ++n) {
        const auto begin = value.begin() + static_cast<std::ptrdiff_t>(n * width);
        samples[n] = {step[n], time[n], std::vector<Real>(begin, begin + static_cast<std::ptrdiff_t>(width))};
    }
    return samples;
}

/// The three numbers that `part` names of every node.
template <class Node>
void store_nodes_of(const std::string& path, const std::vector<Node>& nodes, std::array<Real, 3> Node::*part,
                    Hdf5Writer& file)
{
    std::vector<Real> rows;
    rows.reserve(3 * nodes.size());
    for (const Node& node : nodes) rows.insert(rows.end(), (node.*part).begin(), (node.*part).end());
    store(path, rows, 3, file);
}

template <class Node>
void load_nodes_of(const Hdf5Reader& file, const std::string& path, std::size_t count, std::array<Real, 3> Node::*part,
                   std::vector<Node>& nodes)
{
    const auto rows = file.dataset<Real>(path);
    if (rows.size() != 3 * count) damaged(file, "the nodes do not fit the leaves");
    nodes.assign(count, {});
    for (std::size_t n = 0; n < count; ++n)
        for (std::size_t a = 0; a < 3; ++a) (nodes[n].*part)[a] = rows[3 * n + a];
}

/// Motion of all nodes, the force they begin the next step with and their mean velocity; nodal scheme only.
void store_nodes(const solver::State& state, Hdf5Writer& file)
{
    if (!state.lattice.in_use()) return;
    std::vector<Real> motion;
    for (const grid::NodeMotion& node : state.levels.motion) {
        motion.insert(motion.end(), node.velocity.begin(), node.velocity.end());
        motion.insert(motion.end(), node.change.begin(), node.change.end());
    }
    store("/levels/motion", motion, 6, file);
    store_nodes_of("/levels/force", state.levels.force, &grid::NodeForce::force, file);
    if (!state.levels.mean.empty())
        store_nodes_of("/levels/mean_velocity", state.levels.mean, &grid::NodeMean::velocity, file);
}

void load_nodes(const Hdf5Reader& file, solver::State& state)
{
    if (!file.exists("/levels/motion")) return;
    const auto motion = file.dataset<Real>("/levels/motion");
    const std::size_t nodes = state.levels.leaves.size() * grid::tile_nodes;
    if (motion.size() != 6 * nodes) damaged(file, "the nodes do not fit the leaves");
    state.levels.motion.assign(nodes, {});
    for (std::size_t n = 0; n < nodes; ++n)
        for (std::size_t a = 0; a < 3; ++a) {
            state.levels.motion[n].velocity[a] = motion[6 * n + a];
            state.levels.motion[n].change[a] = motion[6 * n + 3 + a];
        }
    load_nodes_of(file, "/levels/force", nodes, &grid::NodeForce::force, state.levels.force);
    if (file.exists("/levels/mean_velocity"))
        load_nodes_of(file, "/levels/mean_velocity", nodes, &grid::NodeMean::velocity, state.levels.mean);
}
} // namespace

void store_state(const solver::State& state, Hdf5Writer& file)
{
    store_particles(state.particles, file);
    store_levels(state.levels, file);
    store_nodes(state, file);
    store_rows("/clock", std::vector{state.clock}, file);
    store_rows("/loads", state.loads, file);
    store_rows("/ligaments", state.ligaments, file);
    store_rows("/events", state.events, file);
    store_rows("/leaf_work", state.leaf_work, file);
    store_rows("/folded_work", std::vector{state.folded_work}, file);
    file.attribute("/", "initial_energy", state.initial_energy);
    file.attribute("/", "source_work", state.source_work);
    file.attribute("/", "damped_work", state.damped_work);
    store_samples(state.samples, file);
    store_history(state.history, state.levels.count, file);
    file.group("/gauge");
    store("/gauge/upper", state.gauge_upper, 1, file);
    store("/gauge/lower", state.gauge_lower, 1, file);
    file.attribute("/gauge", "start", state.gauge_start);
    file.attribute("/gauge", "largest_opening", state.largest_opening);
}

solver::State load_state(const Hdf5Reader& file)
{
    solver::State state;
    state.particles = load_particles(file);
    state.levels = load_levels(state.particles.size(), file);
    load_nodes(file, state);
    state.clock = load_row<solver::Clock>("/clock", file);
    state.loads = load_rows<solver::LoadState>("/loads", file);
    state.ligaments = load_rows<solver::LigamentState>("/ligaments", file);
    state.events = load_rows<solver::LigamentEvent>("/events", file);
    state.leaf_work = load_rows<solver::LeafWork>("/leaf_work", file);
    state.folded_work = load_row<solver::LeafWork>("/folded_work", file);
    state.initial_energy = file.attribute<Real>("/", "initial_energy").at(0);
    state.source_work = file.attribute<Real>("/", "source_work").at(0);
    state.damped_work = file.attribute<Real>("/", "damped_work").at(0);
    state.samples = load_samples(file);
    state.history = load_history(state.levels.count, file);
    state.gauge_upper = file.dataset<std::uint32_t>("/gauge/upper");
    state.gauge_lower = file.dataset<std::uint32_t>("/gauge/lower");
    state.gauge_start = file.attribute<Real>("/gauge", "start").at(0);
    state.largest_opening = file.attribute<Real>("/gauge", "largest_opening").at(0);
    return state;
}
} // namespace io
