/// What particles give to the nodes: mass, momentum and force at the end of a step, momentum alone in the middle.
#pragma once

#include "transfer/gimp_lines.h"

namespace transfer
{
/// The gifts of up to `Lanes::lanes` particles. First by quantity, then `turn` makes them the lines of each particle.
template <Transfer T>
struct BoxStage
{
    static constexpr bool affine = T == Transfer::apic;
    static constexpr int lines = affine ? 4 : 2;
    alignas(64) Real row[lines][8][Lanes::lanes]; // [line][quantity][particle]
    NodeLine line[Lanes::lanes][lines];

    /// Zero all but what `all` or the momentum alone writes; with APIC no force follows the base line.
    explicit BoxStage(BoxGive give)
    {
        for (int n = 0; n < lines; ++n)
            for (int q = 0; q < 8; ++q)
                if (give == BoxGive::momentum || q % 4 == 3 || (affine && (q == 0 || (n == 0 && q >= 4))))
                    Lanes(Real(0)).store(row[n][q]);
    }

    Real* mass() { return row[0][0]; }
    Real* momentum(std::size_t a) { return row[0][1 + a]; }
    /// m C(a, b)
    Real* affine_momentum(std::size_t a, std::size_t b) { return row[1 + b][1 + a]; }
    /// -V sigma(a, b). Without APIC the three slopes are half lines: the one along x follows mass and momentum.
    Real* flux(std::size_t a, std::size_t b)
    {
        if constexpr (affine) return row[1 + b][4 + a];
        return row[(b + 1) / 2][a + (b == 1 ? 0 : 4)];
    }

    void turn()
    {
        for (int n = 0; n < lines; ++n) {
            Lanes quantity[8];
            for (int q = 0; q < 8; ++q) quantity[q] = Lanes::load(row[n][q]);
            lanes_to_lines(quantity, [&](int i, int place, const Lanes& piece) {
                line[i][n].part[place / NodeLine::piece] = piece;
            });
        }
    }

    GiftLines of(int i) const
    {
        if constexpr (affine) return {line[i][0], {line[i][1], line[i][2], line[i][3]}};
        const NodeLine zero(Real(0)), both = line[i][1];
        return {line[i][0], {zero, detail::lower_halves(zero, both), detail::halves(zero, both)}};
    }

    BoxGift gift(int i) const
    {
        GiftLines from = of(i);
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
void stage_momentum(const particles::Particles& particles, std::size_t begin, int count, BoxStage<T>& stage)
{
    const Lanes m = load(particles.mass, begin, count);
    for (std::size_t a = 0; a < 3; ++a) {
        (m * load(particles.velocity[a], begin, count)).store(stage.momentum(a));
        if constexpr (T == Transfer::apic)
            for (std::size_t b = 0; b < 3; ++b)
                (m * load(particles.affine[3 * a + b], begin, count)).store(stage.affine_momentum(a, b));
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
        const GiftLines gift = stage.of(i);
        scatter_walks<T == Transfer::apic, Give>[static_cast<std::size_t>(weights.code(i))](
            weights, i, gift, tile.node + weights.node(i));
    }
}
} // namespace transfer
