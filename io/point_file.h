/// point.csv: one line per step of a material point.
#pragma once

#include "solver/point.h"

#include <string>
#include <vector>

namespace io
{
/// Header and lines. Strains are tensor components in fixed axes; works are per volume, decohesion_N_per_mm is per
/// crack area: work times L_e. Intact points have mode 0 and zeros for what a crack has.
std::string point_csv(const std::vector<solver::PointState>& history);
} // namespace io
