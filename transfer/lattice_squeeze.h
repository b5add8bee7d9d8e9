/// What the choice of the time step asks the lattice for.
#pragma once

#include "transfer/lattice.h"

namespace transfer
{
/// survey_lattice without the energy, which stays 0: stress is not read.
void survey_squeeze(const LawTable& laws, const Lattice& lattice, const particles::Particles& particles,
                    const grid::Levels& levels, std::vector<LatticeSurvey>& survey);
} // namespace transfer
