/// The complete, constant description of one run: what the case file says after every default is filled in.
///
/// Units are mm, g, ms (so N, MPa, mJ). A Problem is valid before the first step and never changes after; io/case.cpp
/// is its only author, besides tests.
#pragma once

#include "core/real.h"
#include "geometry/shape.h"
#include "material/material.h"
#include "particles/seed.h"
#include "refine/zone.h"
#include "solver/motion.h"
#include "solver/quantity.h"
#include "transfer/scheme.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace solver
{
using transfer::Basis;
using transfer::Formulation;
using transfer::Precision;
using transfer::StressUpdate;
using transfer::Transfer;

using particles::EdgeTreatment;

struct Grid
{
    Real cell = 0;              // mm, spacing of level 0
    int levels = 1;             // 1, number of levels; spacing of level l is cell / 2^l
    int particles_per_cell = 8; // 1, a cube number
    Vec3 origin = Vec3::Zero(); // mm, a node of every level
    EdgeTreatment edge = EdgeTreatment::fraction;
};

using refine::Zone;

struct Body
{
    std::string name;
    geometry::Shape shape;
    int material = 0;                   // index into Problem::materials
    Vec3 velocity = Vec3::Zero();       // mm/ms, initial
    std::optional<int> initial = {};    // index into Problem::motions: the state it begins with
    std::optional<int> body_force = {}; // likewise: whose body force acts on it
};

struct Numerics
{
    Basis basis = Basis::trilinear;
    Formulation formulation = Formulation::total;
    StressUpdate stress_update = StressUpdate::usl;
    Transfer transfer = Transfer::flip;
    Precision precision = Precision::f64;
    Real pic_fraction = 0;                                       // 1, share of PIC in the FLIP velocity update
    Real damping = 0;                                            // 1/ms, a in v' = f / m - a (v - u)
    Real damping_memory = std::numeric_limits<Real>::infinity(); // ms, u is the mean of v over it; infinite: 0
    Real cfl = 0.5;                                              // 1, dt = cfl * min h / c_d
    bool subcycling = false;  // nodal scheme: each level has twice the step of the next finer one
    Real mass_cutoff = 1e-10; // 1, nodes lighter than this share of a full cell's mass are inactive
    bool damps_fast_motion_only() const { return damping > 0 && !std::isinf(damping_memory); }
};

/// Normal velocity zero on a coordinate plane that coincides with a node plane of every level.
struct SymmetryPlane
{
    int axis = 2; // 0 x, 1 y, 2 z
    Real at = 0;  // mm
};

/// Ramp of a prescribed velocity: C2 (10 s^3 - 15 s^4 + 6 s^5), linear or a step, from 0 to 1 over `time`.
struct Ramp
{
    enum class Kind
    {
        smooth_step,
        linear,
        step,
    };
    Kind kind = Kind::smooth_step;
    Real time = 0; // ms
};

/// A load: either nodes of a region with prescribed velocity components, or a rigid pin glued to the wall of a hole.
struct Load
{
    enum class Kind
    {
        region,
        pin,
    };
    std::string name;
    Kind kind = Kind::region;
    geometry::Shape region;                      // at time 0
    Vec3 centre = Vec3::Zero();                  // mm, of a pin, on its axis
    int axis = 2;                                // of a pin: it turns freely about this axis
    std::array<std::optional<Real>, 3> velocity; // mm/ms, full speed; empty component: free
    Ramp ramp;
};

/// A force on part of the surface, per area at time 0, with its direction kept: dead loading.
struct SurfaceLoad
{
    enum class Kind
    {
        pressure, // MPa, against the outward normal
        traction, // MPa
        force,    // N in all, on the modelled part
    };
    std::string name;
    geometry::Shape region; // faces whose centre lies in it
    Kind kind = Kind::pressure;
    Real pressure = 0;          // MPa
    Vec3 vector = Vec3::Zero(); // MPa or N
    std::optional<Vec3> facing; // only faces that look this way
    Ramp ramp;
};

/// Distance between two material points along a direction, minus its value at time 0: the COD.
struct Gauge
{
    Vec3 upper = Vec3::Zero(); // mm
    Vec3 lower = Vec3::Zero(); // mm
    int axis = 1;
};

/// A named void (hole, notch tip, edge) that a crack can start from or run into.
struct Feature
{
    std::string name; // such as "A"
    geometry::Shape shape;
    Vec3 centre = Vec3::Zero(); // mm, used by polylines through features
};

/// The corridor between two features whose through-thickness separation is an event.
struct Ligament
{
    std::string from, to;                      // feature names
    std::vector<std::array<Real, 2>> corridor; // mm, polygon in the plane normal to `through`
    int through = 2;                           // axis of the thickness
};

struct OutputEvery
{
    std::optional<Real> time;  // ms
    std::optional<long> steps; // 1
    std::optional<Real> cod;   // mm
};

struct Output
{
    OutputEvery history;
    OutputEvery probes; // of measures; none: with the history
    OutputEvery particles;
    std::vector<std::string> particle_fields; // names of io/particle_fields.h
    std::string particle_precision = "f32";   // or "f64"
    OutputEvery grid;
    std::vector<std::string> grid_fields; // names of io/grid_file.h
    OutputEvery vdb;
    std::vector<std::string> vdb_grids; // density, damage, eq_plastic_strain, velocity
    std::string vdb_preset = "blender"; // or "houdini"
    Real vdb_scale = 1;                 // scene units per mm
    Real checkpoint_every_wall = 900;   // s
    int checkpoint_keep = 2;
    bool checkpoint_at_end = false; // one more when the run ends, so that it can go on to a later end
};

/// End of a run: whichever comes first.
struct End
{
    Real time = std::numeric_limits<Real>::infinity(); // ms
    Real cod = std::numeric_limits<Real>::infinity();  // mm
    bool separated = true; // stop when the force is below 1 % of its peak (observe.h, finished)
};

/// Published numbers to print beside the run, such as Table 1 of the paper.
struct Reference
{
    std::string name;                    // such as "experiment"
    std::map<std::string, Real> measure; // names of run.json measures
    std::string crack_path;
};

struct Problem
{
    std::string title;
    Grid grid;
    Numerics numerics;
    std::vector<material::Material> materials;
    std::vector<Body> bodies;
    std::vector<Feature> features;
    std::vector<Zone> zones;
    std::vector<SymmetryPlane> symmetry;
    std::vector<Load> loads;
    std::vector<SurfaceLoad> surface_loads;
    std::vector<Motion> motions;
    std::vector<Quantity> quantities;
    Vec3 gravity = Vec3::Zero(); // mm/ms^2
    std::optional<Gauge> gauge;
    std::string force_upper, force_lower; // names of the loads whose reactions are the history's two forces
    int force_axis = 1;
    std::vector<Ligament> ligaments;
    std::vector<std::string> start_features; // where a crack path may start, such as "A"
    Real mean_over = 0;                      // mm, opening before a crack initiation for its mean force; 0: none
    End end;
    Output output;
    std::vector<Reference> references;

    /// Force on the full specimen over that on the modelled part, along `axis`: 2 for every plane parallel to it.
    Real symmetry_factor(int axis) const;
    /// Box about all bodies at rest [mm].
    /// @pre there is one
    geometry::Bounds bounds() const;
};
} // namespace solver
