/// Whole scenes in code: a bar, a plate with pins, and how to advance them.
#pragma once

#include "grid/damping.h"
#include "solver/nodal.h"
#include "solver/step.h"

#include <limits>

namespace support
{
struct Job
{
    solver::Problem problem;
    solver::Prepared prepared;
    solver::Derived derived;
    solver::State state;
};

inline Job started(const solver::Problem& problem)
{
    Job run{problem, solver::prepare(problem), {}, {}};
    run.state = solver::initialise(run.problem, run.prepared, run.derived);
    return run;
}

inline void advance(int steps, Job& run)
{
    for (int n = 0; n < steps; ++n) solver::advance(run.problem, run.prepared, run.state, run.derived);
}

/// Begin again with what `change(particles)` makes of the state at time 0, whatever the scheme.
template <class Change>
void restart_with(const Change& change, Job& run)
{
    const bool nodal = solver::nodal(run.problem);
    solver::State& state = run.state;
    if (nodal) {
        transfer::fill_columns(state.levels, state.lattice, state.particles);
        state.levels.sum.resize(state.levels.motion.size());
    }
    change(state.particles);
    transfer::scatter(run.prepared.options, run.prepared.laws, state.strays, state.particles, state.levels);
    if (nodal) solver::start_nodal(run.prepared, state);
    if (run.problem.numerics.damps_fast_motion_only()) grid::start_means(state.levels);
}

/// Particles with every column, whatever the scheme.
inline particles::Particles particles_of(Job& run)
{
    const solver::OutputColumns columns(run.state);
    return run.state.particles;
}

/// What is left of a run when only a checkpoint is: particles in stored order, leaves with their active cells, loads
/// and clock; nodal: motion and force of the nodes.
inline Job resumed(const Job& run)
{
    Job again{run.problem, run.prepared, {}, run.state};
    solver::State& state = again.state;
    if (solver::nodal(run.problem)) {
        transfer::fill_columns(state.levels, state.lattice, state.particles);
        state.lattice = {};
        for (grid::NodeForce& node : state.levels.force) node.per_mass = 0;
    } else {
        state.levels.motion.clear();
    }
    state.levels.topology = nullptr;
    state.levels.sum.clear();
    state.levels.interface.clear();
    state.strays = {};
    solver::resume(again.problem, again.prepared, state, again.derived);
    return again;
}

/// A formulation with the stress update the case reader gives it.
inline solver::Numerics numerics(solver::Formulation formulation)
{
    solver::Numerics n;
    n.formulation = formulation;
    n.stress_update =
        formulation == solver::Formulation::updated ? solver::StressUpdate::musl : solver::StressUpdate::usl;
    return n;
}

/// Boxes, in the updated formulation.
inline solver::Numerics gimp_numerics(solver::Transfer transfer)
{
    solver::Numerics n = numerics(solver::Formulation::updated);
    n.basis = solver::Basis::gimp;
    n.transfer = transfer;
    return n;
}

/// The nodal scheme.
inline solver::Numerics nodal_numerics(solver::Precision precision)
{
    solver::Numerics n;
    n.transfer = solver::Transfer::nodal;
    n.precision = precision;
    return n;
}

/// The same, sub-cycled.
inline solver::Numerics subcycled_numerics(solver::Precision precision)
{
    solver::Numerics n = nodal_numerics(precision);
    n.subcycling = true;
    return n;
}

/// E = 1000 MPa, nu = 0.3, 1e-3 g/mm^3: c_d = 1160 mm/ms.
inline material::Material metal()
{
    material::Material m;
    m.name = "metal";
    m.elastic = {1e-3, 1000, 0.3};
    return m;
}

inline solver::Load load(const std::string& name, const geometry::Shape& region,
                         const std::array<std::optional<Real>, 3>& velocity, Real ramp_time)
{
    solver::Load l;
    l.name = name;
    l.region = region;
    l.velocity = velocity;
    l.ramp.time = ramp_time;
    return l;
}

inline solver::Load pin(const std::string& name, const Vec3& centre, Real radius,
                        const std::array<std::optional<Real>, 3>& velocity, Real ramp_time)
{
    const Vec3 along(0, 0, 100);
    solver::Load l = load(name, geometry::cylinder(centre - along, centre + along, radius), velocity, ramp_time);
    l.kind = solver::Load::Kind::pin;
    l.centre = centre;
    return l;
}

/// Region beyond `at` along an axis: above it (side +1) or below (side -1).
inline geometry::Shape beyond(int axis, Real at, int side)
{
    Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
    point[axis] = at;
    normal[axis] = -side;
    return geometry::half_space(point, normal);
}

/// Bar [0, 2] x [0, 4] x [0, 1] of one material, cells of 0.5 mm, its lowest cells held and its
/// highest pulled along y. (A region without thickness would lose its nodes as it moves through the lattice.)
inline solver::Problem bar(const material::Material& material, Real speed, Real ramp_time)
{
    solver::Problem problem;
    problem.title = "bar";
    problem.grid.cell = 0.5;
    problem.materials = {material};
    problem.bodies = {{"bar", geometry::box({0, 0, 0}, {2, 4, 1}), 0, Vec3::Zero()}};
    problem.loads = {load("top", beyond(1, 3.5, 1), {0.0, speed, 0.0}, ramp_time),
                     load("bottom", beyond(1, 0.5, -1), {0.0, 0.0, 0.0}, ramp_time)};
    problem.force_upper = "top";
    problem.force_lower = "bottom";
    problem.end.separated = false;
    return problem;
}

/// Plate [-3, 3] x [-4, 4] x [0, 1] with two holes on x = 0, pulled apart by pins in them.
inline solver::Problem plate(const material::Material& material, Real speed, Real ramp_time)
{
    const auto hole = [](Real y) { return geometry::cylinder({0, y, -1}, {0, y, 2}, 1); };
    solver::Problem problem;
    problem.title = "plate";
    problem.grid.cell = 0.5;
    problem.materials = {material};
    problem.bodies = {
        {"plate", geometry::subtract(geometry::box({-3, -4, 0}, {3, 4, 1}), {hole(2), hole(-2)}), 0, Vec3::Zero()}};
    problem.loads = {pin("upper", {0, 2, 0}, 1, {0.0, speed, {}}, ramp_time),
                     pin("lower", {0, -2, 0}, 1, {0.0, -speed, {}}, ramp_time)};
    problem.force_upper = "upper";
    problem.force_lower = "lower";
    problem.end.separated = false;
    return problem;
}

/// Refine everything inside a shape.
inline refine::Zone zone(const geometry::Shape& shape, int level)
{
    return {"zone", shape, level, 0};
}

inline geometry::Shape everywhere()
{
    return geometry::box(Vec3::Constant(-100), Vec3::Constant(100));
}

/// The metal with plasticity, and decohesion weak enough for a short run to break it.
inline material::Material breakable()
{
    material::Material m = metal();
    m.plastic = material::VonMises{10, 100};
    m.decohesion = material::Decohesion{};
    m.decohesion->s_max = 11;
    m.decohesion->tau_max = 50;
    m.decohesion->u0 = 2e-3;
    return m;
}
} // namespace support
