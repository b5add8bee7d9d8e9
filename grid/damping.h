/// Damping of the motion on the nodes, of all of it or only of what is faster than its own mean over some time.
///
///     m v' = f + m g - m a (v - u),   u' = (v - u) / T,   or u = 0 without a memory T
///
/// Without one a body that moves steadily is dragged. With one its mean u follows, the drag ends, and a wave of angular
/// frequency o decays as exp(-t a / 2 (o T)^2 / (1 + (o T)^2)): each node pulls a mass a T m along by a dashpot m a.
/// That takes energy and, other than a drag by the size of the force out of balance (Cundall 1987), does not oppose
/// steady motion where there is noise, being linear.
#pragma once

#include "grid/levels.h"

namespace grid
{
struct Damping
{
    Real rate = 0;               // 1/ms, a
    Real memory = 0;             // ms, T; infinite: u = 0
    Real dt = 0;                 // ms
    Vec3 gravity = Vec3::Zero(); // mm/ms^2
};

/// Means of the velocity begin with the velocity.
void start_means(Levels& levels);

/// Damp owned nodes by the midpoint rule: r = v - u, w = (r + d / 2) / (1 + (a + 1 / T) dt / 2) with d what forces have
/// given the velocity, v+ = v + d - a dt w, u+ = u + dt w / T. The displacement (nodal scheme) or the velocity's change
/// (others) follows. A component that is exactly 0 is held by a wall and stays.
/// @param levels  velocities v + d; reads forces or changes of velocity; means, if there are any
/// @return mJ, work against the drag: sum m a dt w (v + v+) / 2
Real damp_motion(const Damping& damping, Levels& levels);

/// What `damp_motion` would return for each component of a node [mJ].
std::array<Real, 3> damped_energy(const Damping& damping, const NodeAddress& at, const Levels& levels);
} // namespace grid
