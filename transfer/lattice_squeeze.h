/// What the choice of the time step asks the lattice for.
///
/// A particle s of stiffening q_s^2 = max |F_s^{-T} e_a|^2 min(1, J_s) has at most
/// (c_d q_s / (0.63 h / 2))^2 m_s N_n(s) of stiffness in every corner n of its cell (cell_squeeze.h), so waves pass the
/// whole cell as if it were 1/q wide,
///
///   q^2 = max_n  sum_s m_s N_n(s) q_s^2 / sum_s m_s N_n(s),   s: the particles that transmit force,
///
/// N the trilinear weights. A sliver at a cut edge, or one particle of a bent cell, may be drawn out tenfold and weighs
/// little.
#pragma once

#include "transfer/lattice.h"

namespace transfer
{
/// survey_lattice without the energy, which stays 0: stress is not read.
void survey_squeeze(const LawTable& laws, const Lattice& lattice, const particles::Particles& particles,
                    const grid::Levels& levels, std::vector<LatticeSurvey>& survey);
} // namespace transfer
