/// What the stages of the lattice kernel hand on for one part of a block (transfer/advance_lattice.cpp).
#pragma once

#include "transfer/lattice.h"

namespace transfer
{
struct Context
{
    const PassOptions& options;
    const LawTable& laws;
    const Lattice& lattice;
    Real per_spacing; // 1/mm
    std::size_t leaf;
};

/// Material constants of one slot of every cell of a part.
template <class T>
struct SlotLaw
{
    PartLanes<T> lame, shear, yield, hardening, per_overstress, tensile_onset, shear_onset;
    PartLanes<T> averaged; // 1 where the dilatation is averaged, else 0
};

/// What the stages of a part of a block hand on; 15 kB at most, so it stays in the nearest cache.
template <class T>
struct Work
{
    using V = PartLanes<T>;
    Slopes<V> displacement[3];    // mm, [component]
    core::Mat<V> gradient[slots]; // 1, L dt in the middle of the step
    V rest_volume[slots];         // mm^3; of separating particles the metal part once their law has been called
    V volume[slots];              // mm^3, V0 J in the middle of the step
    SlotLaw<T> law[slots];        // of leaves with several materials; the first else
};

template <class V>
core::Mat<Real> lane_of(const core::Mat<V>& lanes, int lane)
{
    core::Mat<Real> m{};
    for (std::size_t n = 0; n < 9; ++n) m.m[n] = static_cast<Real>(lanes.m[n][lane]);
    return m;
}

template <class V>
core::Mat<Real> deformation_of_lane(const Slopes<V> (&displacement)[3], int slot, int lane, Real per_spacing)
{
    core::Mat<Real> f = core::identity<Real>();
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
            f(a, b) += per_spacing * static_cast<Real>(displacement[a].along[b][slope_place(b, slot)][lane]);
    return f;
}

/// @param lane  of the block
template <class T>
core::Sym<Real> stress_at(const BlockState<T>& state, std::size_t lane, int slot)
{
    core::Sym<Real> stress{};
    for (std::size_t n = 0; n < 6; ++n)
        stress.s[n] = static_cast<Real>(state.stress[n][static_cast<std::size_t>(slot)][lane]);
    return stress;
}

template <class T>
void set_lane(SlotLaw<T>& law, int lane, const LawConstants& c)
{
    law.lame.v[lane] = static_cast<T>(c.lame);
    law.shear.v[lane] = static_cast<T>(c.shear);
    law.yield.v[lane] = static_cast<T>(c.yield);
    law.hardening.v[lane] = static_cast<T>(c.hardening);
    law.per_overstress.v[lane] = static_cast<T>(c.per_overstress);
    law.tensile_onset.v[lane] = static_cast<T>(c.tensile_onset);
    law.shear_onset.v[lane] = static_cast<T>(c.shear_onset);
    law.averaged.v[lane] = c.averaged_dilatation ? T(1) : T(0);
}

template <class T>
SlotLaw<T> broadcast(const LawConstants& c)
{
    const auto lanes = [](Real value) { return PartLanes<T>(static_cast<T>(value)); };
    return {
        lanes(c.lame),           lanes(c.shear),         lanes(c.yield),       lanes(c.hardening),
        lanes(c.per_overstress), lanes(c.tensile_onset), lanes(c.shear_onset), lanes(c.averaged_dilatation ? 1 : 0)};
}

/// Laws slot by slot, for a leaf of several materials.
template <class T>
[[gnu::noinline]] void mixed_laws(const Context& context, const BlockPart<T>& part,
                                  const particles::Particles& particles, SlotLaw<T> (&law)[slots])
{
    for (int s = 0; s < slots; ++s) {
        law[s] = broadcast<T>(context.laws.constants[0]);
        for (int i = 0; i < part.count(); ++i)
            if (part.has(i, s)) set_lane(law[s], i, context.laws.constants[particles.material[part.particle(i, s)]]);
    }
}

/// Laws of the part's particles; slot s has law[s * step], and step is returned: 0 where one law serves all.
template <class T>
int find_laws(const Context& context, const BlockPart<T>& part, const particles::Particles& particles,
              SlotLaw<T> (&law)[slots])
{
    const std::int32_t material = context.lattice.material[context.leaf];
    if (material == Lattice::mixed) {
        mixed_laws(context, part, particles, law);
        return 1;
    }
    law[0] = broadcast<T>(context.laws.constants[static_cast<std::size_t>(material)]);
    return 0;
}
} // namespace transfer
