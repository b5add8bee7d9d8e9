/// The table of fields a particle file can hold; the case reader checks `output.particles.fields` against it.
#pragma once

#include <array>
#include <string_view>

namespace io
{
struct ParticleField
{
    std::string_view name;
    std::string_view unit;
    int components; // 1 scalar, 3 vector, 6 symmetric tensor xx yy zz xy yz zx (ParaView's order)
    bool integer;
    std::string_view meaning;
};

inline constexpr std::array<ParticleField, 12> particle_fields{{
    {"damage", "1", 1, false, "decohesion: 0 intact, 1 separated; between: share of the cohesive strength lost"},
    {"failure_mode", "1", 1, true, "0 intact, 1 opening, 2 shear, 3 mixed"},
    {"eq_plastic_strain", "1", 1, false, "accumulated equivalent plastic strain"},
    {"von_mises", "MPa", 1, false, "equivalent stress sqrt(3/2 s:s)"},
    {"stress", "MPa", 6, false, "Cauchy stress, tension positive"},
    {"velocity", "mm/ms", 3, false, "velocity"},
    {"displacement", "mm", 3, false, "current minus initial position"},
    {"level", "1", 1, true, "grid level of the home cell, 0 coarsest"},
    {"id", "1", 1, true, "given at seeding, never changes"},
    {"crack_normal", "1", 3, false, "unit normal of the decohesion plane, 0 where intact"},
    {"mass", "g", 1, false, "mass"},
    {"volume", "mm^3", 1, false, "current volume"},
}};

/// The field of that name, or null.
constexpr const ParticleField* find_particle_field(std::string_view name)
{
    for (const ParticleField& field : particle_fields)
        if (field.name == name) return &field;
    return nullptr;
}
} // namespace io
