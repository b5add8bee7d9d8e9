#include "io/case_draft.h"
#include "refine/estimate.h"
#include "solver/begin_motion.h"
#include "solver/external_force.h"
#include "solver/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace io
{
namespace
{
bool in_a_body(const Draft& draft, const Vec3& point)
{
    return std::any_of(draft.problem.bodies.begin(), draft.problem.bodies.end(),
                       [&](const solver::Body& body) { return body.shape.contains(point); });
}

/// Whether any sample of a lattice over the part of `bounds` that bodies can fill fulfils `wanted`; the lattice is as
/// fine as `step`, but never more than about a million points.
template <class Wanted>
bool any_sample(const Draft& draft, const geometry::Bounds& bounds, Real step, const Wanted& wanted)
{
    const geometry::Bounds bodies = draft.problem.bounds();
    const Vec3 lower = bounds.lower.cwiseMax(bodies.lower);
    const Vec3 size = bounds.upper.cwiseMin(bodies.upper) - lower;
    if ((size.array() <= 0).any()) return false;
    step = std::max(step, std::cbrt(size.prod() / 1e6));
    Index3 count;
    for (int a = 0; a < 3; ++a) count[a] = std::max(1, static_cast<int>(std::ceil(size[a] / step)));
    for (int i = 0; i < count[0]; ++i)
        for (int j = 0; j < count[1]; ++j)
            for (int k = 0; k < count[2]; ++k) {
                const Vec3 place(i + 0.5, j + 0.5, k + 0.5);
                const Vec3 share = place.cwiseQuotient(count.cast<Real>());
                if (wanted(Vec3(lower + size.cwiseProduct(share)))) return true;
            }
    return false;
}

/// The same, but not before the finest lattice has found none either: a coarse one, as of large cells, misses things.
template <class Wanted>
bool any_place(const Draft& draft, const geometry::Bounds& bounds, Real step, const Wanted& wanted)
{
    return any_sample(draft, bounds, step, wanted) || any_sample(draft, bounds, 0, wanted);
}

const Place& place_of_cell(const Draft& draft)
{
    return draft.root.find("grid")->find("cell")->place;
}

Real finest_cell(const solver::Grid& grid)
{
    return grid.cell / static_cast<Real>(1 << (grid.levels - 1));
}

void check_particles_per_cell(Draft& draft)
{
    const int count = draft.problem.grid.particles_per_cell;
    const int side = solver::particles_per_axis(draft.problem.grid);
    const Node* grid = draft.root.find("grid");
    const Node* value = grid->find("particles_per_cell");
    const Place& place = value ? value->place : grid->place;
    if (side * side * side != count)
        draft.diagnostics.error(place, fmt::format("particles_per_cell = {} is not a cube number", count),
                                "expected 8, 27 or 64 (1 for tests)");
    else if (count < 4)
        draft.diagnostics.warning(place, fmt::format("{} particle per cell integrates badly", count),
                                  "8 is the usual choice");
}

/// @return whether a run could number them
bool check_particle_count(Draft& draft, const refine::Scene& scene)
{
    if (!refine::may_exceed(scene, refine::most_particles)) return true;
    const std::vector<Real> on_level = refine::estimated_particles(scene);
    const Real count = std::accumulate(on_level.begin(), on_level.end(), Real(0));
    if (count <= refine::most_particles) return true;
    // A little more, for what the estimate leaves out and the digits below.
    const Real cell = 1.1 * draft.problem.grid.cell * std::cbrt(count / refine::most_particles);
    draft.diagnostics.error(place_of_cell(draft),
                            fmt::format("cells of {} mm are about {:.1e} particles: a run numbers {:.1e} at most",
                                        draft.problem.grid.cell, count, refine::most_particles),
                            fmt::format("lengths are in mm; with these zones cells of {:.2g} mm or more", cell));
    return false;
}

/// @return whether all have particles
bool check_bodies(Draft& draft, const refine::Scene& scene)
{
    bool all = true;
    const std::vector<solver::Body>& bodies = draft.problem.bodies;
    const Real cell = draft.problem.grid.cell;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (!refine::holds_particle(scene, bodies[i].shape)) {
            draft.diagnostics.error(draft.bodies[i].place, fmt::format("body '{}' gets no particle", bodies[i].name),
                                    fmt::format("thinner than a cell of {} mm, or an empty shape", cell));
            all = false;
        }
        const Real finest = finest_cell(draft.problem.grid), depth = finest / 2;
        const geometry::Bounds bounds = bodies[i].shape.bounds();
        int thin = 0;
        const Real side = (bounds.upper - bounds.lower).minCoeff(&thin);
        if (side < finest * (1 - 1e-9))
            draft.diagnostics.warning(place_of_cell(draft),
                                      fmt::format("cells of {:.4g} mm, the finest, are wider than body '{}' along {}: "
                                                  "{:.4g} mm",
                                                  finest, bodies[i].name, "xyz"[thin], side),
                                      "its forces will be wrong");
        for (std::size_t j = 0; j < i; ++j) {
            const geometry::Shape both = geometry::intersect({bodies[i].shape, bodies[j].shape});
            if (any_sample(draft, both.bounds(), depth, [&](const Vec3& p) { return both.distance(p) < -depth / 2; }))
                draft.diagnostics.error(draft.bodies[i].place,
                                        fmt::format("body '{}' overlaps body '{}'", bodies[i].name, bodies[j].name),
                                        "both would have mass there");
        }
    }
    return all;
}

void check_zones(Draft& draft, const refine::Scene& scene)
{
    const solver::Problem& problem = draft.problem;
    for (std::size_t i = 0; i < problem.zones.size(); ++i) {
        const solver::Zone& zone = problem.zones[i];
        if (!draft.zones[i].sound) continue;
        const Real spacing = problem.grid.cell / static_cast<Real>(1 << zone.level);
        const geometry::Shape region = geometry::grown(zone.shape, zone.margin);
        if (!any_place(draft, region.bounds(), spacing,
                       [&](const Vec3& p) { return region.contains(p) && in_a_body(draft, p); }))
        {
            draft.diagnostics.error(draft.zones[i].place, fmt::format("zone '{}' lies outside every body", zone.name),
                                    "refines nothing");
            continue;
        }
        if (!refine::refines(scene, zone))
            draft.diagnostics.warning(draft.zones[i].place,
                                      fmt::format("zone '{}' refines nothing: it holds neither the centre nor a corner "
                                                  "of a cell of {} mm",
                                                  zone.name, problem.grid.cell),
                                      "widen it, or give it a margin");
        // Two levels up, the automatic 2:1 grading inserts cells nobody asked for.
        if (zone.level < 2) continue;
        const Real ring = 2 * spacing;
        const bool jump = any_sample(draft, geometry::grown(region, ring).bounds(), spacing, [&](const Vec3& p) {
            const Real distance = region.distance(p);
            return distance > 0 && distance < ring && refine::level_at(problem.zones, p) < zone.level - 1 &&
                   in_a_body(draft, p);
        });
        if (jump)
            draft.diagnostics.warning(
                draft.zones[i].place,
                fmt::format("level jump above 1 at the rim of zone '{}' (level {})", zone.name, zone.level),
                fmt::format("the 2:1 grading adds cells; a zone of level {} around it decides where", zone.level - 1));
    }
    for (int level = 1; level < problem.grid.levels; ++level)
        if (std::none_of(problem.zones.begin(), problem.zones.end(), [&](const auto& z) { return z.level >= level; })) {
            draft.diagnostics.warning(draft.grid.place, fmt::format("no zone uses level {}", level));
            break;
        }
}

void check_symmetry(Draft& draft)
{
    const solver::Problem& problem = draft.problem;
    for (std::size_t i = 0; i < problem.symmetry.size(); ++i) {
        if (!draft.symmetry[i].sound) continue;
        const solver::SymmetryPlane& plane = problem.symmetry[i];
        const char axis = "xyz"[plane.axis];
        const Real node = (plane.at - problem.grid.origin[plane.axis]) / problem.grid.cell;
        if (std::abs(node - std::round(node)) > 1e-9 * std::max(Real(1), std::abs(node)))
            draft.diagnostics.error(
                draft.symmetry[i].place,
                fmt::format("the symmetry plane {} = {} is not on a node plane of level 0", axis, plane.at),
                fmt::format("nearest: {}", problem.grid.origin[plane.axis] + std::round(node) * problem.grid.cell));
        for (std::size_t b = 0; b < problem.bodies.size(); ++b) {
            const geometry::Bounds bounds = problem.bodies[b].shape.bounds();
            const Real tolerance = 1e-9 * problem.grid.cell;
            if (draft.bodies[b].sound && bounds.lower[plane.axis] < plane.at - tolerance &&
                bounds.upper[plane.axis] > plane.at + tolerance)
                draft.diagnostics.error(draft.bodies[b].place,
                                        fmt::format("body '{}' lies on both sides of the symmetry plane {} = {}",
                                                    problem.bodies[b].name, axis, plane.at),
                                        "model one side only");
        }
    }
}

Real slowest_wave(const solver::Problem& problem)
{
    Real speed = std::numeric_limits<Real>::infinity();
    for (const material::Material& material : problem.materials) speed = std::min(speed, material.elastic.wave_speed());
    return speed;
}

void check_loads(Draft& draft, const refine::Scene& scene, bool materials_sound)
{
    const solver::Problem& problem = draft.problem;
    // Cells of the updated formulation follow particles to where a motion has put them at the beginning.
    const bool at_rest =
        !solver::begins_with_motion(problem) || problem.numerics.formulation == solver::Formulation::total;
    for (std::size_t i = 0; i < problem.loads.size(); ++i) {
        const solver::Load& load = problem.loads[i];
        if (!draft.loads[i].sound) continue;
        // A pin holds the wall of its hole: material within one cell of it.
        const bool pin = load.kind == solver::Load::Kind::pin;
        const geometry::Shape reach = pin ? geometry::grown(load.region, problem.grid.cell) : load.region;
        if (!any_place(draft, reach.bounds(), problem.grid.cell / 4,
                       [&](const Vec3& p) { return reach.contains(p) && in_a_body(draft, p); }))
            draft.diagnostics.error(draft.loads[i].place, fmt::format("load '{}' touches no body", load.name),
                                    pin ? "the pin has no wall within one cell" : "no material in its region");
        else if (at_rest && !refine::holds_node(scene, load.region))
            draft.diagnostics.error(
                draft.loads[i].place, fmt::format("load '{}' holds no node with mass", load.name),
                fmt::format("its region lies between nodes; cells of level 0 are {} mm wide", problem.grid.cell));
        if (pin && in_a_body(draft, load.centre))
            draft.diagnostics.error(draft.loads[i].place,
                                    fmt::format("the centre of pin '{}' lies in a body, not in a hole", load.name));
        Real speed = 0;
        for (const std::optional<Real>& component : load.velocity) speed += std::pow(component.value_or(0), 2);
        speed = std::sqrt(speed);
        if (materials_sound && speed > 0.01 * slowest_wave(problem))
            draft.diagnostics.warning(draft.loads[i].place,
                                      fmt::format("load '{}' moves at {:.3g} mm/ms, {:.1f} % of the slowest wave speed",
                                                  load.name, speed, 100 * speed / slowest_wave(problem)),
                                      "inertia will show in the forces");
    }
}

/// Another load of the same nodes replaces what an earlier one prescribes: often a copy whose region was not changed.
void check_same_regions(Draft& draft)
{
    const std::vector<solver::Load>& loads = draft.problem.loads;
    const auto region_of = [&](const solver::Load& load) {
        const Node* written = draft.resolved.find("load")->find(load.name);
        const Node* region = written->find("region");
        return write_value(region ? *region : *written->find("pin"));
    };
    const auto differ = [](const solver::Load& a, const solver::Load& b, std::size_t axis) {
        if (!a.velocity[axis] || !b.velocity[axis]) return false;
        const bool same_ramp = a.ramp.kind == b.ramp.kind && a.ramp.time == b.ramp.time;
        return *a.velocity[axis] != *b.velocity[axis] || (*a.velocity[axis] != 0 && !same_ramp);
    };
    for (std::size_t i = 0; i < loads.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (!draft.loads[i].sound || !draft.loads[j].sound || !differ(loads[i], loads[j], axis)) continue;
                if (region_of(loads[i]) != region_of(loads[j])) continue;
                draft.diagnostics.warning(
                    draft.loads[i].place,
                    fmt::format("load '{}' has the region of load '{}' and another velocity along {}", loads[i].name,
                                loads[j].name, "xyz"[axis]),
                    "the last one in the case prescribes it");
            }
}

void check_surface_loads(Draft& draft)
{
    const solver::Problem& problem = draft.problem;
    for (std::size_t i = 0; i < problem.surface_loads.size(); ++i) {
        if (!draft.surface_loads[i].sound) continue;
        const geometry::Shape reach = geometry::grown(problem.surface_loads[i].region, problem.grid.cell);
        if (!any_place(draft, reach.bounds(), problem.grid.cell / 4,
                       [&](const Vec3& p) { return reach.contains(p) && in_a_body(draft, p); }))
            draft.diagnostics.error(draft.surface_loads[i].place,
                                    fmt::format("load '{}' touches no body", problem.surface_loads[i].name),
                                    "no material within a cell of its region");
    }
}

/// Points on a face or a symmetry plane are fine, and so is the particle nearest to them.
void require_material(Draft& draft, const Place& place, const std::string& what, const Vec3& point, Real reach)
{
    Real distance = std::numeric_limits<Real>::infinity();
    for (const solver::Body& body : draft.problem.bodies) distance = std::min(distance, body.shape.distance(point));
    if (distance > reach)
        draft.diagnostics.error(place, fmt::format("{} lies {:.3g} mm outside every body", what, distance),
                                "choose a point of the material");
}

void check_gauge(Draft& draft)
{
    const solver::Problem& problem = draft.problem;
    if (!problem.gauge) {
        if (draft.end.sound && std::isfinite(problem.end.cod))
            draft.diagnostics.error(draft.end.place, "the end by opening needs a gauge", "add [gauge.cod]");
        if (draft.every_cod.file >= 0)
            draft.diagnostics.error(draft.every_cod, "output by opening needs a gauge", "add [gauge.cod]");
        return;
    }
    if (!draft.gauge.sound) return;
    for (const auto& [name, point] : {std::pair("upper", problem.gauge->upper), {"lower", problem.gauge->lower}})
        require_material(draft, draft.root.find("gauge")->find("cod")->find(name)->place,
                         fmt::format("gauge point '{}'", name), point, 0.5 * problem.grid.cell);
}

void check_measures(Draft& draft)
{
    const solver::Problem& problem = draft.problem;
    const Node* list = draft.root.find("measure");
    if (!list || draft.diagnostics.error_count() > 0 || list->items.size() != problem.quantities.size()) return;
    for (std::size_t i = 0; i < problem.quantities.size(); ++i) {
        const solver::Quantity& quantity = problem.quantities[i];
        const auto require = [&](const Vec3& point, const std::optional<Real>& radius) {
            require_material(draft, list->items[i].place, fmt::format("a point of measure '{}'", quantity.name), point,
                             std::max(radius.value_or(0), problem.grid.cell / 2));
        };
        if (const auto* probe = std::get_if<solver::Probe>(&quantity.kind); probe && probe->point)
            require(*probe->point, probe->radius);
        if (const auto* difference = std::get_if<solver::Difference>(&quantity.kind)) {
            require(difference->first, difference->radius);
            require(difference->second, difference->radius);
        }
    }
}

void check_forces(Draft& draft)
{
    const solver::Problem& problem = draft.problem;
    if (problem.loads.empty() || !problem.force_upper.empty() || !problem.force_lower.empty()) return;
    if (problem.gauge || !problem.ligaments.empty())
        draft.diagnostics.warning(draft.end.place,
                                  "no [forces]: the forces of history.csv, events.csv and the measures are 0",
                                  "name the loads: [forces] upper = \"...\", lower = \"...\"");
}

/// A ball that holds no more than its cell leaves the strengths to the cells; one larger than the body is a slip.
void check_nonlocal_radius(Draft& draft)
{
    const solver::Problem& problem = draft.problem;
    const Real finest = finest_cell(problem.grid);
    for (std::size_t m = 0; m < problem.materials.size(); ++m) {
        const material::Material& material = problem.materials[m];
        if (!draft.materials[m].sound || !material.decohesion || material.decohesion->nonlocal_radius <= 0) continue;
        const Real radius = material.decohesion->nonlocal_radius;
        Real largest = 0;
        for (const solver::Body& body : problem.bodies)
            if (body.material == static_cast<int>(m))
                largest = std::max(largest, (body.shape.bounds().upper - body.shape.bounds().lower).maxCoeff());
        const Node* law = draft.root.find("material")->find(material.name)->find("decohesion");
        const Place& place = law->find("nonlocal_radius")->place;
        if (radius < finest * (1 - 1e-9))
            draft.diagnostics.warning(place,
                                      fmt::format("nonlocal_radius {:.4g} mm is below the finest cells, {:.4g} mm: the "
                                                  "mean is that of one cell",
                                                  radius, finest),
                                      "at least two cells, or strengths hang on the cells");
        if (largest > 0 && radius > largest)
            draft.diagnostics.warning(place,
                                      fmt::format("nonlocal_radius {:.4g} mm is more than the bodies of '{}' are long, "
                                                  "{:.4g} mm",
                                                  radius, material.name, largest),
                                      "the mean is that of all of them");
    }
}

void check_subcycling(Draft& draft)
{
    if (!draft.problem.numerics.subcycling || !solver::has_external_forces(draft.problem)) return;
    draft.diagnostics.error(draft.root.find("numerics")->find("subcycling")->place,
                            "subcycling = true cannot be combined with surface loads or body forces of a motion",
                            "their impulses are not split between levels");
}

bool all_sound(const std::vector<Origin>& origins)
{
    return std::all_of(origins.begin(), origins.end(), [](const Origin& origin) { return origin.sound; });
}
} // namespace

void check_case(Draft& draft)
{
    if (!draft.grid.sound) return;
    check_particles_per_cell(draft);
    check_symmetry(draft);
    // Whether something lies in a body can only be told when every body is known, and what was cut out of it.
    if (draft.problem.bodies.empty() || !all_sound(draft.bodies) || !all_sound(draft.features)) return;
    const refine::Scene scene = solver::scene_of(draft.problem);
    if (!check_particle_count(draft, scene) || !check_bodies(draft, scene)) return;
    check_zones(draft, scene);
    check_loads(draft, scene, all_sound(draft.materials) && !draft.materials.empty());
    check_same_regions(draft);
    check_surface_loads(draft);
    check_nonlocal_radius(draft);
    check_subcycling(draft);
    check_gauge(draft);
    check_measures(draft);
    check_forces(draft);
}
} // namespace io
