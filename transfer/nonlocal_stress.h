/// The stress that a cell's onset is tested on, and the strength it is held against (transfer/nonlocal_onset.h).
#pragma once

#include "transfer/nonlocal_view.h"

#include <cstdint>
#include <optional>

namespace transfer
{
/// Ratio of a cell's own stress to the strength beyond which neither the ball nor a neighbour holds it back [1]. No
/// ball of metal in one piece leaves that much out: of the particles that start in the challenge specimen nine tenths
/// exceed the strength by less than 5 %. Scraps between pieces of a crack, or slivers at a rim, whose ball is empty of
/// stress, would be drawn out for ever.
inline constexpr Real overload = 1.25;

/// A cell and material that may start, with the stress it is tested on.
struct Candidate
{
    std::size_t slot = 0;
    std::uint8_t material = 0;
    core::Sym<Real> tested{};   // MPa, mean of its ball or of the cell
    std::optional<Real> lode{}; // 1, L of its shear strength; empty: that of the tested stress
    Real excess = 0;            // 1, largest ratio of stress to strength; <= 1: the criterion is not met
    bool overloaded = false;    // its own mean is beyond `overload`: starts whatever stands beside it
};

inline std::uint64_t key_of(const Candidate& candidate)
{
    return candidate.slot * 256 + candidate.material;
}

/// The ball about a candidate's cell.
Ball ball_of(const NonlocalView& view, const particles::Particles& particles, const Candidate& candidate);

/// Stress to test: the mean of the ball, with a law that has lode_memory against the strength of the state that the
/// cell remembers (material/lode_memory.h). An overloaded cell is tested on its own mean; where a crack arrives, on
/// that of the metal that the crack would cut next, if both this and its own mean exceed the criterion further than the
/// ball's. The tip of a crack makes a state of its own at once, so those two go by the state of the moment.
///
/// @param candidate  reads slot, material; writes the rest
/// @param particles  reads stress and plastic strain; writes lode_mean, lode_strain of the cell's intact particles
void choose_tested(const NonlocalView& view, Candidate& candidate, particles::Particles& particles);
} // namespace transfer
