#include "particles/order.h"

#include "core/parallel.h"

namespace particles
{
void reorder(std::span<const std::uint32_t> order, Particles& particles)
{
    const auto gather = [&](const auto&, auto& column) {
        if (column.empty()) return;
        auto moved = column;
        moved.resize(order.size());
        core::parallel_for((order.size() + 4095) / 4096, [&](std::size_t block) {
            const std::size_t end = std::min(order.size(), (block + 1) * 4096);
            for (std::size_t n = block * 4096; n < end; ++n) moved[n] = column[order[n]];
        });
        column = std::move(moved);
    };
    Particles::for_each_real(particles, gather);
    Particles::for_each_integer(particles, gather);
}
} // namespace particles
