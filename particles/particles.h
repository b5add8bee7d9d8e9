/// Particles as one struct of columns; `for_each_real` and `for_each_integer` are the only places that name every
/// field.
///
/// Resize, ordering, splitting, output and restart walk them, so a new field is two lines. The order of particles
/// is the order of their home cells (level, leaf, cell), see particles/order.h.
#pragma once

#include "core/column_allocator.h"
#include "core/crack.h"
#include "core/real.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace particles
{
using Column = std::vector<Real, core::ColumnAllocator<Real>>;

using core::Crack;

struct Particles
{
    std::array<Column, 3> position;             // [p] mm, current
    std::array<Column, 3> rest_position;        // [p] mm, at time 0
    std::array<Column, 3> velocity;             // [p] mm/ms
    std::array<Column, 6> stress;               // [p] MPa, Cauchy: xx yy zz xy yz zx, tension positive
    std::array<Column, 9> deformation_gradient; // [p] 1, row-major F; empty in the updated formulation
    std::array<Column, 9> affine;               // [p] 1/ms, row-major C of APIC; empty otherwise
    Column volume_ratio;                        // [p] 1, J = V / V0; empty in the total formulation
    Column rest_volume;                         // [p] mm^3
    Column mass;                                // [p] g
    Column eq_plastic_strain;                   // [p] 1
    Column lode_mean;                           // [p] 1, L_m of its cell (material/lode_memory.h); empty if none asks
    Column lode_strain;                         // [p] 1, plastic strain of its cell then; -1: none yet; empty likewise
    std::vector<std::int32_t> crack;            // [p] index into cracks, -1 intact
    std::vector<std::uint32_t> id;              // [p] 1, given at seeding, never changes
    std::vector<std::uint8_t> target_level;     // [p] level its zone asks for
    std::vector<std::uint8_t> size_level;       // [p] level whose particle spacing it has
    std::vector<std::uint8_t> material;         // [p] index into Problem::materials
    std::vector<std::uint8_t> body;             // [p] index into Problem::bodies
    std::vector<std::uint8_t> away;             // [p] 1: has left its home cell since the last ordering

    std::vector<Crack> cracks; // side table, in order of onset

    std::size_t size() const { return mass.size(); }

    /// Every per-particle column of reals with its name, in a fixed order; empty columns stay empty.
    /// `visit(name, column)` is called for each.
    template <class Self, class Visit>
    static void for_each_real(Self& self, Visit&& visit);

    /// Every per-particle column of integers, likewise.
    template <class Self, class Visit>
    static void for_each_integer(Self& self, Visit&& visit);
};

template <class Self, class Visit>
void Particles::for_each_real(Self& self, Visit&& visit)
{
    constexpr std::string_view axes[3] = {"x", "y", "z"};
    constexpr std::string_view sym[6] = {"xx", "yy", "zz", "xy", "yz", "zx"};
    constexpr std::string_view mat[9] = {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
    const auto visit_all = [&](std::string_view name, const auto& suffix, auto& columns) {
        for (std::size_t i = 0; i < columns.size(); ++i)
            visit(std::string(name) + "_" + std::string(suffix[i]), columns[i]);
    };
    visit_all("position", axes, self.position);
    visit_all("rest_position", axes, self.rest_position);
    visit_all("velocity", axes, self.velocity);
    visit_all("stress", sym, self.stress);
    visit_all("deformation_gradient", mat, self.deformation_gradient);
    visit_all("affine", mat, self.affine);
    visit(std::string("volume_ratio"), self.volume_ratio);
    visit(std::string("rest_volume"), self.rest_volume);
    visit(std::string("mass"), self.mass);
    visit(std::string("eq_plastic_strain"), self.eq_plastic_strain);
    visit(std::string("lode_mean"), self.lode_mean);
    visit(std::string("lode_strain"), self.lode_strain);
}

template <class Self, class Visit>
void Particles::for_each_integer(Self& self, Visit&& visit)
{
    visit("crack", self.crack);
    visit("id", self.id);
    visit("target_level", self.target_level);
    visit("size_level", self.size_level);
    visit("material", self.material);
    visit("body", self.body);
    visit("away", self.away);
}
} // namespace particles
