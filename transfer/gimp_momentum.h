/// What particles give to the nodes: mass, momentum and force at the end of a step, momentum alone in the middle.
#pragma once

#include "transfer/gimp_lines.h"

namespace transfer
{
/// The gifts of up to `Lanes::lanes` particles by quantity, lanes = particles.
template <Transfer T>
struct BoxRows
{
    static constexpr bool affine = T == Transfer::apic;
    Lanes row[gift_lines(affine)][8]; // [line][quantity]

    /// Zero all but what `all` or the momentum alone sets; with APIC no force follows the base line.
    [[gnu::always_inline]] explicit BoxRows(BoxGive give)
    {
        for (int n = 0; n < gift_lines(affine); ++n)
            for (int q = 0; q < 8; ++q)
                if (give == BoxGive::momentum || q % 4 == 3 || (affine && (q == 0 || (n == 0 && q >= 4))))
                    row[n][q] = Lanes(Real(0));
    }

    Lanes& mass() { return row[0][0]; }
    Lanes& momentum(int a) { return row[0][1 + a]; }
    /// m C(a, b)
    Lanes& affine_momentum(int a, int b) { return row[1 + b][1 + a]; }
    /// -V sigma(a, b). Without APIC the three slopes are half lines: the one along x follows mass and momentum.
    Lanes& flux(int a, int b)
    {
        if constexpr (affine) return row[1 + b][4 + a];
        return row[(b + 1) / 2][a + (b == 1 ? 0 : 4)];
    }
};

/// The same as lines, particle by particle.
template <Transfer T>
struct BoxStage
{
    static constexpr bool affine = T == Transfer::apic;
    NodeLine line[Lanes::lanes][gift_lines(affine)];

    [[gnu::always_inline]] explicit BoxStage(const BoxRows<T>& rows)
    {
        for (int n = 0; n < gift_lines(affine); ++n)
            lanes_to_lines(rows.row[n], [&](int i, int place, const Lanes& piece) {
                line[i][n].part[place / NodeLine::piece] = piece;
            });
    }

    BoxGift gift(int i) const
    {
        GiftLines from = detail::unfolded<affine>(line[i]);
        if constexpr (!affine) {
            const NodeLine zero(Real(0));
            from.slope[0] = detail::halves(zero, from.base);
            from.base = detail::halves(from.base, zero);
        }
        BoxGift to;
        from.base.store(to.base.data());
        for (std::size_t b = 0; b < 3; ++b) from.slope[b].store(to.slope[b].data());
        return to;
    }
};

/// Momentum and the affine part of it.
template <Transfer T>
[[gnu::always_inline]] inline void stage_momentum(const particles::Particles& particles, std::size_t begin, int count,
                                                  Lanes mass, const core::Vec<Lanes>& velocity, BoxRows<T>& rows)
{
    for (int a = 0; a < 3; ++a) {
        rows.momentum(a) = mass * velocity[a];
        if constexpr (T == Transfer::apic)
            for (int b = 0; b < 3; ++b)
                rows.affine_momentum(a, b) =
                    mass * load(particles.affine[static_cast<std::size_t>(3 * a + b)], begin, count);
    }
}

/// Add the boxes that the map serves to the sums in reach; for the others `cut(i)` is called, in order.
template <Transfer T, BoxGive Give, class Cut>
[[gnu::always_inline]] inline void add_boxes(const ReachMap& map, const BoxWeights& weights, int count,
                                             const BoxStage<T>& stage, ReachTile<grid::NodeSum>& tile, const Cut& cut)
{
    for (int i = 0; i < count; ++i) {
        if (!served(map, weights, i)) {
            cut(i);
            continue;
        }
        scatter_walks<T == Transfer::apic, Give>[static_cast<std::size_t>(weights.code(i))](
            weights, i, stage.line[i], tile.node + weights.node(i));
    }
}
} // namespace transfer
