#include "solver/ligament_events.h"

#include <cmath>

namespace solver
{
namespace
{
int front_mark(Real front)
{
    return static_cast<int>(std::floor(front / front_interval * (1 + 1e-12)));
}
} // namespace

std::string_view event_name(EventKind kind)
{
    constexpr std::string_view names[] = {"onset", "first", "front", "through"};
    return names[static_cast<int>(kind)];
}

void log_events(const std::vector<LigamentState>& before, const std::vector<LigamentState>& after, std::int64_t step,
                const Observation& now, std::vector<LigamentEvent>& events)
{
    for (std::size_t i = 0; i < after.size(); ++i) {
        const LigamentState old = i < before.size() ? before[i] : LigamentState{};
        const LigamentState& fresh = after[i];
        const auto note = [&](EventKind kind) {
            events.push_back({step, now.time, now.force, now.cod, fresh.front, static_cast<std::int32_t>(i), kind});
        };
        if (old.onset_time < 0 && fresh.onset_time >= 0) note(EventKind::onset);
        if (old.first_time < 0 && fresh.first_time >= 0) note(EventKind::first);
        if (front_mark(fresh.front) > front_mark(old.front)) note(EventKind::front);
        if (old.through_time < 0 && fresh.through_time >= 0) note(EventKind::through);
    }
}
} // namespace solver
