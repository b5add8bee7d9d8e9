/// The choices that shape the particle passes; they sit here, below the solver, because the kernels are compiled for
/// each combination.
#pragma once

namespace transfer
{
enum class Basis
{
    trilinear, // particles are points
    gimp,      // particles are boxes (transfer/gimp_box.h); in the total formulation the same as trilinear
};

enum class Formulation
{
    updated, // weights at current positions
    total,   // weights at rest positions, first Piola stress
};

enum class StressUpdate
{
    usl,  // from the updated nodal velocity
    musl, // from nodal velocities mapped again from the updated particles
};

enum class Precision
{
    f64,
    mixed, // nodes in double, state and arithmetic of the particles in single precision; nodal scheme
};

enum class Transfer
{
    flip, // FLIP blended with `pic_fraction` of PIC
    apic,
    nodal, // the nodes keep velocity and displacement; total formulation (transfer/lattice.h)
};
} // namespace transfer
