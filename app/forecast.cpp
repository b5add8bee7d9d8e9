#include "app/forecast.h"

#include "io/particle_fields.h"
#include "refine/estimate.h"
#include "refine/populate.h"
#include "refine/zone.h"
#include "solver/lattice.h"
#include "solver/stable_time_step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

namespace app
{
namespace
{
constexpr Real infinity = std::numeric_limits<Real>::infinity();

using LeafKey = std::array<int, 4>; // level and leaf position

LeafKey leaf_of(const solver::Problem& problem, const particles::Particles& particles, std::size_t p)
{
    const int level = particles.size_level[p];
    const Real side = 8 * problem.grid.cell / static_cast<Real>(1 << level);
    LeafKey key{level, 0, 0, 0};
    for (std::size_t a = 0; a < 3; ++a)
        key[a + 1] =
            static_cast<int>(std::floor((particles.position[a][p] - problem.grid.origin[static_cast<int>(a)]) / side));
    return key;
}

Real fastest_wave(const solver::Problem& problem)
{
    Real fastest = 0;
    for (const material::Material& material : problem.materials)
        fastest = std::max(fastest, material.elastic.wave_speed());
    return fastest;
}

/// Prescribed speed of a named load along an axis [mm/ms].
Real speed_of(const solver::Problem& problem, const std::string& name, int axis)
{
    for (const solver::Load& load : problem.loads)
        if (load.name == name) return load.velocity[static_cast<std::size_t>(axis)].value_or(0);
    return 0;
}

/// Time until the run ends at the latest; the opening is taken to follow the loads, half of a ramp late.
Real end_time(const solver::Problem& problem)
{
    Real ramp = 0;
    for (const solver::Load& load : problem.loads) ramp = std::max(ramp, load.ramp.time);
    const Real speed = std::abs(speed_of(problem, problem.force_upper, problem.force_axis) -
                                speed_of(problem, problem.force_lower, problem.force_axis));
    const Real by_opening = speed > 0 ? problem.end.cod / speed + ramp / 2 : infinity;
    return std::min(problem.end.time, by_opening);
}

/// One at every multiple of the intervals, and one at the end if that is none.
Real frames(const solver::OutputEvery& every, const Forecast& forecast, const solver::Problem& problem)
{
    Real count = 0;
    bool any = false, at_end = false;
    const auto add = [&](Real intervals) {
        const Real whole = std::floor(intervals * (1 + 1e-12)); // as the schedule of a run counts
        any = any || intervals > 0;
        at_end = at_end || intervals - whole < 1e-9;
        count += whole;
    };
    if (every.time) add(forecast.end_time / *every.time);
    if (every.steps) add(forecast.steps / static_cast<Real>(*every.steps));
    if (every.cod && std::isfinite(problem.end.cod)) add(problem.end.cod / *every.cod);
    return any && !at_end ? count + 1 : count;
}

Real bytes_per_written_particle(const solver::Output& output)
{
    const Real real = output.particle_precision == "f64" ? 8 : 4;
    Real bytes = 4 * real + 4; // place, side, and the connectivity that compresses to little
    for (const std::string& name : output.particle_fields)
        if (const io::ParticleField* field = io::find_particle_field(name))
            bytes += static_cast<Real>(field->components) * real;
    return bytes;
}

/// Cells with particles, and the coarser ones they fill.
Real grid_frame_bytes(const solver::Problem& problem, const Forecast& forecast)
{
    Real cells = 0, on_level = 0;
    for (std::size_t l = forecast.particles.size(); l-- > 0;) {
        on_level = on_level / 8 + static_cast<Real>(forecast.particles[l]) / problem.grid.particles_per_cell;
        cells += on_level;
    }
    Real bytes = 1; // mark of a refined cell
    for (const std::string& name : problem.output.grid_fields) {
        const io::ParticleField* field = io::find_particle_field(name);
        bytes += 4 * static_cast<Real>(field ? field->components : 1);
    }
    return cells * bytes;
}

/// All voxels are as fine as the finest level: a particle of a coarser one fills 8, 64, ... of them.
Real vdb_frame_bytes(const solver::Problem& problem, const Forecast& forecast)
{
    Real voxels = 0;
    for (std::size_t l = 0; l < forecast.particles.size(); ++l)
        voxels += static_cast<Real>(forecast.particles[l]) / problem.grid.particles_per_cell *
                  std::pow(8.0, static_cast<Real>(forecast.particles.size() - 1 - l));
    Real bytes = 0;
    for (const std::string& grid : problem.output.vdb_grids) bytes += grid == "velocity" ? 6 : 2;
    return voxels * bytes;
}

/// Kinetic energy density at the loads' speed over the elastic energy density at yield: rho v^2 E / sigma_y^2.
Real kinetic_share(const solver::Problem& problem)
{
    Real speed_squared = 0, share = 0;
    for (const solver::Load& load : problem.loads) {
        Real squared = 0;
        for (const std::optional<Real>& component : load.velocity) squared += std::pow(component.value_or(0), 2);
        speed_squared = std::max(speed_squared, squared);
    }
    for (const material::Material& material : problem.materials)
        if (material.plastic)
            share = std::max(share, material.elastic.density * speed_squared * material.elastic.youngs_modulus /
                                        std::pow(material.plastic->yield_stress, 2));
    return share;
}
} // namespace

Real memory_of(const ParticleCount& counted)
{
    return program_bytes + bytes_per_particle * static_cast<Real>(counted.total_particles()) +
           bytes_per_leaf * static_cast<Real>(counted.leaves);
}

std::uint64_t ParticleCount::total_particles() const
{
    std::uint64_t total = 0;
    for (const std::uint64_t count : particles) total += count;
    return total;
}

Real assumed_steps_per_s(const solver::Numerics& numerics)
{
    if (numerics.transfer != solver::Transfer::nodal) return 20e6;
    return numerics.precision == solver::Precision::mixed ? 70e6 : 45e6;
}

std::string grid_sections(const std::string& resolved)
{
    std::istringstream lines(resolved);
    std::string sections, line;
    bool wanted = false;
    while (std::getline(lines, line)) {
        if (line.starts_with('['))
            wanted = line.starts_with("[grid]") || line.starts_with("[feature.") || line.starts_with("[[body]]") ||
                     line.starts_with("[[refine.");
        if (wanted) sections += line + '\n';
    }
    return sections;
}

ParticleCount estimate_particles(const solver::Problem& problem)
{
    ParticleCount count;
    count.estimated = true;
    const Real of_leaf = 512 * static_cast<Real>(problem.grid.particles_per_cell);
    for (const Real particles : refine::estimated_particles(solver::scene_of(problem))) {
        count.particles.push_back(static_cast<std::uint64_t>(particles));
        count.leaves += static_cast<std::uint64_t>(std::ceil(particles / of_leaf));
    }
    return count;
}

// Seed one slab of level-0 cells after the other, count, forget.
ParticleCount count_particles(const solver::Problem& problem)
{
    if (refine::may_exceed(solver::scene_of(problem), countable)) {
        const ParticleCount estimate = estimate_particles(problem);
        if (static_cast<Real>(estimate.total_particles()) > countable) return estimate;
    }
    const refine::Lattice lattice = solver::lattice_of(problem.grid);
    const grid::Refinement refinement = refine::refinement_of(problem.zones, lattice, problem.bounds());
    const int per_axis = solver::particles_per_axis(problem.grid);
    const Real thickness = 8 * problem.grid.cell;
    std::set<LeafKey> leaves;
    ParticleCount count;
    count.particles.assign(static_cast<std::size_t>(problem.grid.levels), 0);
    for (const solver::Body& body : problem.bodies) {
        const geometry::Bounds bounds = body.shape.bounds();
        const int first = static_cast<int>(std::floor((bounds.lower[0] - problem.grid.origin[0]) / thickness));
        for (int slab = first; problem.grid.origin[0] + slab * thickness < bounds.upper[0]; ++slab) {
            const Real lower = problem.grid.origin[0] + slab * thickness;
            const geometry::Shape layer =
                geometry::box(Vec3(lower, -infinity, -infinity), Vec3(lower + thickness, infinity, infinity));
            particles::Particles particles;
            const particles::SeedTraits traits{1, Vec3::Zero(), 0, problem.grid.edge};
            refine::populate(geometry::intersect({body.shape, layer}), traits, lattice, refinement, per_axis,
                             particles);
            for (std::size_t p = 0; p < particles.size(); ++p) {
                ++count.particles[particles.size_level[p]];
                leaves.insert(leaf_of(problem, particles, p));
            }
        }
    }
    count.leaves = leaves.size();
    return count;
}

Forecast forecast(const solver::Problem& problem)
{
    return forecast(problem, count_particles(problem));
}

Forecast forecast(const solver::Problem& problem, const ParticleCount& counted)
{
    Forecast forecast{counted};
    const Real finest = problem.grid.cell / static_cast<Real>(1 << (problem.grid.levels - 1));
    forecast.dt = problem.numerics.cfl * finest / fastest_wave(problem);
    forecast.end_time = end_time(problem);
    forecast.steps = std::ceil(forecast.end_time / (solver::substeps(problem) * forecast.dt));
    for (std::size_t l = 0; l < forecast.particles.size(); ++l)
        forecast.particle_steps += forecast.steps * static_cast<Real>(forecast.particles[l]) *
                                   (problem.numerics.subcycling ? Real(1 << l) : Real(1));
    const Real particles = static_cast<Real>(forecast.total_particles());
    forecast.memory = memory_of(counted);
    forecast.particle_frames = frames(problem.output.particles, forecast, problem);
    forecast.particle_bytes = forecast.particle_frames * particles * bytes_per_written_particle(problem.output);
    forecast.grid_frames = frames(problem.output.grid, forecast, problem);
    forecast.grid_bytes = forecast.grid_frames * grid_frame_bytes(problem, forecast);
    forecast.vdb_frames = frames(problem.output.vdb, forecast, problem);
    forecast.vdb_bytes = forecast.vdb_frames * vdb_frame_bytes(problem, forecast);
    forecast.kinetic_share = kinetic_share(problem);
    return forecast;
}

std::string level_map(const solver::Problem& problem, int columns)
{
    const geometry::Bounds bounds = problem.bounds();
    const Vec3 size = bounds.upper - bounds.lower;
    int through = 0;
    size.minCoeff(&through);
    const int u = (through + 1) % 3, v = (through + 2) % 3;
    const grid::Refinement refinement = refine::refinement_of(problem.zones, solver::lattice_of(problem.grid), bounds);
    // One character per coarse cell if they fit; a character is about twice as tall as it is wide.
    const Real width = std::max(problem.grid.cell, size[u] / std::max(columns, 10));
    const Real height = 2 * width;
    const int across = static_cast<int>(std::ceil(size[u] / width - 1e-9));
    const int down = static_cast<int>(std::ceil(size[v] / height - 1e-9));
    std::string map;
    for (int row = 0; row < down; ++row) {
        for (int column = 0; column < across; ++column) {
            Vec3 at = (bounds.lower + bounds.upper) / 2;
            at[u] = bounds.lower[u] + (column + 0.5) * width;
            at[v] = bounds.upper[v] - (row + 0.5) * height;
            const bool solid = std::any_of(problem.bodies.begin(), problem.bodies.end(),
                                           [&](const solver::Body& body) { return body.shape.contains(at); });
            const int level = refinement.locate((at - problem.grid.origin) / problem.grid.cell).level;
            map += solid ? static_cast<char>('0' + level) : '.';
        }
        map += '\n';
    }
    return map;
}
} // namespace app
