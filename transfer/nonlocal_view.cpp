#include "transfer/nonlocal_view.h"

#include "particles/tensors.h"

#include <variant>

namespace transfer
{
namespace
{
/// Result of `read(state, slot, lane)` where the nodal scheme keeps a particle.
template <class Read>
auto in_block(const NonlocalView& view, std::uint32_t p, const Read& read)
{
    return std::visit(
        [&]<class T>(const BlockTable<T>& blocks) {
            const std::size_t place = view.table.place[p];
            const std::size_t lane = place % block_lanes<T>, row = place / block_lanes<T>;
            return read(blocks.state[row / slots], row % slots, lane);
        },
        view.lattice.blocks);
}
} // namespace

std::vector<std::uint32_t> lattice_places(const Lattice& lattice, std::size_t count)
{
    std::vector<std::uint32_t> places(count);
    std::visit(
        [&]<class T>(const BlockTable<T>& blocks) {
            for (std::size_t b = 0; b < blocks.block.size(); ++b)
                for (int s = 0; s < slots; ++s)
                    for (int i = 0; i < blocks.block[b].count; ++i)
                        if (blocks.block[b].has(i, s))
                            places[blocks.block[b].particle(i, s)] =
                                static_cast<std::uint32_t>((b * slots + static_cast<std::size_t>(s)) * block_lanes<T> +
                                                           static_cast<std::size_t>(i));
        },
        lattice.blocks);
    return places;
}

core::Sym<Real> stress_of(const NonlocalView& view, const particles::Particles& particles, std::uint32_t p)
{
    if (!view.lattice.in_use()) return particles::stress_of(particles, p);
    return in_block(view, p, [](const auto& state, std::size_t slot, std::size_t lane) {
        core::Sym<Real> stress{};
        for (std::size_t n = 0; n < 6; ++n) stress.s[n] = static_cast<Real>(state.stress[n][slot][lane]);
        return stress;
    });
}

Real plastic_strain_of(const NonlocalView& view, const particles::Particles& particles, std::uint32_t p)
{
    if (!view.lattice.in_use()) return particles.eq_plastic_strain[p];
    return in_block(view, p, [](const auto& state, std::size_t slot, std::size_t lane) {
        return static_cast<Real>(state.eq_plastic_strain[slot][lane]);
    });
}

core::Sym<Real> mean_of(const NonlocalView& view, const particles::Particles& particles, const Ball& ball)
{
    return mean_stress(
        ball, [&](std::uint32_t p) { return stress_of(view, particles, p); },
        [&](std::uint32_t p) { return particles.crack[p] < 0; });
}

const material::Decohesion* nonlocal_law(const LawTable& laws, std::uint8_t material)
{
    const auto& law = laws.materials[material].decohesion;
    return law && law->nonlocal_radius > 0 ? &*law : nullptr;
}
} // namespace transfer
