/// What `cleave point` shows of a path: curves as SVG and a summary as text.
#pragma once

#include "solver/point_path.h"

#include <string>
#include <vector>

namespace app
{
/// Three charts below each other: stresses over the strain that changes most, damage and plastic strain over it, and
/// tractions on the crack plane over opening and slip.
/// @pre one state at least
std::string point_charts(const std::vector<solver::PointState>& history);

/// Onset, strengths, lengths and snap-back, energies, end state.
std::string point_summary(const solver::PointPath& path, const std::vector<solver::PointState>& history);
} // namespace app
