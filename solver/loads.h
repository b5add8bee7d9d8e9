/// Prescribed motion of nodes: regions with given velocity components, and rigid pins that turn freely.
///
/// Reaction = momentum the load gives the body per time: m (v_prescribed - v_old) / dt - f summed over its nodes, where
/// v_old is what the transfer carries on (FLIP: the prescribed velocity before; PIC and APIC: the mapped one), so the
/// sum of reactions is exactly the change of the particles' momentum. Where several loads hold the same component of a
/// node the last one in the case prescribes it; each gives what its velocity differs by from that of those before it.
#pragma once

#include "grid/levels.h"
#include "solver/prepared.h"
#include "solver/state.h"

#include <vector>

namespace solver
{
/// Nodes a load holds now; rebuilt when the leaves change or (updated formulation) the region has moved on.
struct LoadNodes
{
    std::vector<grid::NodeAddress> node;
    std::vector<Vec3> position;       // mm
    std::vector<std::uint8_t> before; // bit a: an earlier load of the case holds component a of the node
    Vec3 shift = Vec3::Zero();        // mm, quantised displacement the nodes were found for
};

/// Share of the finest spacing by which a region may move before its nodes are looked up again.
inline constexpr Real load_shift_quantum = 0.05;

/// Whether a load prescribes that velocity component of its nodes.
bool holds(const Load& load, int axis);

/// Value in [0, 1] of a ramp at `time` [ms].
Real ramp_value(const Ramp& ramp, Real time);

/// Find the owned, unconstrained nodes inside every load's region.
void find_load_nodes(const Problem& problem, const grid::Levels& levels, const std::vector<LoadState>& loads,
                     std::vector<LoadNodes>& nodes);

/// Forget the nodes without mass: the nodal scheme knows that they never get any.
/// @pre  masses assembled and restricted
void keep_heavy_nodes(const grid::Levels& levels, std::vector<LoadNodes>& nodes);

/// True if some region has moved by a quantum since its nodes were found.
bool load_nodes_outdated(const Problem& problem, const std::vector<LoadState>& loads,
                         const std::vector<LoadNodes>& nodes);

/// Prescribe the velocity at time + dt: overwrite motion of the held nodes, advance displacement and spin, add
/// reaction, impulse and external work. A pin's spin follows its angular-momentum balance
///   omega+ = sum r x (m v_old + dt f) / sum m r^2.
/// @param time  ms, beginning of the step
/// @error core::NumericalError if a load has lost the body: none of its nodes has mass
void apply_loads(const Problem& problem, const Prepared& prepared, const std::vector<LoadNodes>& nodes, Real time,
                 Real dt, grid::Levels& levels, std::vector<LoadState>& loads);

/// Put the prescribed velocity into `change` again, after MUSL's second mapping.
void hold_loads(const Problem& problem, const std::vector<LoadNodes>& nodes, grid::Levels& levels);
} // namespace solver
