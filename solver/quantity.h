/// What a case asks to be measured: a number of the present state, and how its values over the run become one result.
///
/// A closed list of kinds, one struct each, evaluated in the files quantity_*.cpp.
#pragma once

#include "core/real.h"
#include "geometry/shape.h"

#include <optional>
#include <string>
#include <variant>

namespace solver
{
/// A field of the particles with the component wanted.
struct FieldComponent
{
    enum class Field
    {
        displacement,      // mm
        velocity,          // mm/ms
        position,          // mm
        stress,            // MPa, Cauchy
        von_mises,         // MPa
        pressure,          // MPa, - tr(stress) / 3
        eq_plastic_strain, // 1
        damage,            // 1
    };
    enum class Component
    {
        x,
        y,
        z,
        magnitude,
        radial, // vectors: along the radius about `axis` through `centre`; stress: radial-radial
        around, // vectors: tangential; stress: hoop
        xx,
        yy,
        zz,
        xy,
        yz,
        zx,
        radial_around, // stress
        first,         // largest principal stress
    };
    Field field = Field::displacement;
    Component component = Component::x;
    Vec3 centre = Vec3::Zero(); // mm
    int axis = 2;
};

/// Field at a point (linear fit over the particles around it) or mean, largest or smallest in a region.
struct Probe
{
    enum class Over
    {
        mean, // weighted by current volume
        max,
        min,
    };
    FieldComponent field;
    std::optional<Vec3> point;  // mm, at time 0
    std::optional<Real> radius; // mm, of the fit; absent: 1.5 cells
    geometry::Shape region;     // at time 0
    Over over = Over::mean;
};

/// Field at the first point minus that at the second.
struct Difference
{
    FieldComponent field;
    Vec3 first = Vec3::Zero(), second = Vec3::Zero(); // mm, at time 0
    std::optional<Real> radius;
};

/// Of a load: its force on the body (mean since the sample before, full specimen), displacement or work.
struct LoadQuantity
{
    enum class What
    {
        force,        // N
        displacement, // mm
        work,         // mJ, modelled part
    };
    bool on_surface = false; // index into surface_loads, else loads
    std::size_t load = 0;
    What what = What::force;
    int component = 1;
};

/// Present extent of the material: particles with the half widths F gives them (updated formulation: J^(1/3)).
struct Extent
{
    enum class What
    {
        length,
        upper,
        lower,
        radius, // largest distance of a particle's far side from the axis
    };
    std::optional<int> body;
    geometry::Shape region; // at time 0
    int axis = 0;
    What what = What::length;
    Vec3 centre = Vec3::Zero(); // mm
};

/// A term of the ledger, modelled part [mJ]; residual_share is the residual over external + initial.
struct Energy
{
    enum class What
    {
        kinetic,
        elastic,
        plastic,
        decohesion,
        external,
        damping,
        residual,
        residual_share,
        total, // kinetic + elastic
    };
    What what = What::residual_share;
};

/// Momentum of the particles along an axis [g mm/ms], or angular momentum about a line along it [g mm^2/ms].
struct Momentum
{
    bool angular = false;
    int axis = 0;
    Vec3 centre = Vec3::Zero(); // mm
};

/// Current volume of the particles in a region [mm^3].
struct Volume
{
    geometry::Shape region; // at time 0
};

/// Norm of the difference from a motion in closed form: l2 sqrt(sum V0 |e|^2 / sum V0), or max |e|. Velocity is
/// compared half a step before the present time, where the scheme has it.
struct FieldError
{
    enum class Norm
    {
        l2,
        max,
    };
    FieldComponent::Field field = FieldComponent::Field::displacement; // displacement, velocity or stress
    std::size_t motion = 0;                                            // index into Problem::motions
    Norm norm = Norm::l2;
    geometry::Shape region; // at time 0
};

/// Of the particles with decohesion state in a region.
struct CrackQuantity
{
    enum class What
    {
        energy,     // mJ, of the whole model: the ledger's decohesion
        softening,  // mJ, sum of V0 / L_e times what the softening law dissipated per area (material/decohesion.h)
        separated,  // 1, number of separated particles
        volume,     // mm^3, rest volume of the separated
        area,       // mm^2, sum of damage V0 / L_e
        angle,      // degree, of the line through the separated ones in the plane normal to `axis`, from the next axis
        length,     // mm, extent of the separated ones along that line
        tip,        // mm, largest rest coordinate of a separated one along `axis`
        onset_time, // ms, of the first onset
    };
    What what = What::energy;
    geometry::Shape region; // at time 0
    int axis = 2;
};

/// Result of one measure over that of another.
struct Ratio
{
    std::size_t of = 0, over = 0; // index into Problem::quantities
};

/// How values at many times become one.
struct Reduction
{
    enum class At
    {
        end,
        max,
        min,
        mean,
        amplitude, // (max - min) / 2
        period,    // mean distance of upward crossings of the mean
        fourier,   // amplitude at `frequency`
        when_max,  // value when `of` was largest
        when_min,
    };
    At at = At::end;
    std::optional<Real> time;        // ms, value at this time instead, linear between samples
    std::optional<Real> from, until; // ms, window
    Real frequency = 0;              // 1/ms
    std::size_t of = 0;              // index into Problem::quantities
};

struct Quantity
{
    std::string name;
    std::variant<Probe, Difference, LoadQuantity, Extent, Energy, Momentum, Volume, FieldError, CrackQuantity, Ratio>
        kind;
    Reduction reduction;
    Real scale = 1;                // 1, of the result
    std::optional<Real> reference; // published or exact result
    std::optional<Real> tolerance; // 1, of the error
};
} // namespace solver
