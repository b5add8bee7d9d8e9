/// What happens on the ligaments, in the order it happens: the lines of events.csv.
#pragma once

#include "solver/ligaments.h"
#include "solver/state.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace solver
{
/// A front that advances is noted each time its share of the ligament passes a multiple of this.
inline constexpr Real front_interval = 0.05;

/// "onset", "first", "front", "through".
std::string_view event_name(EventKind kind);

/// Append what `after` has and `before` had not, ligament by ligament: onset, first broken column, the front beyond
/// another multiple of front_interval, separation. `before` may be empty: nothing had happened.
void log_events(const std::vector<LigamentState>& before, const std::vector<LigamentState>& after, std::int64_t step,
                const Observation& now, std::vector<LigamentEvent>& events);
} // namespace solver
