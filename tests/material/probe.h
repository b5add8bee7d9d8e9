/// One particle that separates: strained step by step from its onset, with its energies.
#pragma once

#include "material/decohesion.h"
#include "material/separation.h"
#include "tests/material/samples.h"

#include <gtest/gtest.h>

namespace material
{
struct Probe
{
    SeparationLaw law;
    core::Crack crack;
    Sym stress;
    double eq_plastic_strain = 0;
    double decohesion_work = 0, plastic_work = 0, stress_work = 0; // mJ/mm^3
    double stored = 0;                                             // mJ/mm^3, at onset
    double dt = 1e-6, time = 0;

    /// @param start  MPa, at a strength: the crack begins a millionth beyond it
    Probe(const Material& material, const Sym& start, double spacing, const Mat& l = {})
        : law(separation_law(material)), stress(1.000001 * start), stored(elastic_energy(material.elastic, stress))
    {
        crack = onset(*material.decohesion, material.elastic, stress, stress, {l, {}}, spacing, 0).value();
    }

    void strain(const Sym& increment, const Vec& spin = {})
    {
        time += dt;
        const Sym before = core::rotated(incremental_rotation(plane_spin(spin, increment, normal())), stress);
        const DecohesionStep step = separate(law, crack, {stress, increment, spin, eq_plastic_strain, dt, time});
        const double rounding = law.rotating_until > 0 ? 1e-10 * stored : 0;
        EXPECT_GE(step.decohesion_work, -rounding);
        EXPECT_GE(step.plastic_work, 0);
        EXPECT_GE(step.crack.damage, crack.damage);
        stress = step.stress;
        crack = step.crack;
        eq_plastic_strain = step.eq_plastic_strain;
        decohesion_work += step.decohesion_work;
        plastic_work += step.plastic_work;
        stress_work += core::contract(0.5 * (before + stress), increment);
    }

    Vec normal() const { return {crack.normal}; }
    double dissipated() const { return decohesion_work * crack.effective_length; } // N/mm per crack area
    /// Stored at onset and put in since, less what is dissipated and stored now [mJ/mm^3].
    double missing_energy(const Elastic& elastic) const
    {
        return stored + stress_work - decohesion_work - plastic_work - elastic_energy(elastic, stress);
    }
};
} // namespace material
