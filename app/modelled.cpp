#include "app/modelled.h"

#include "solver/stable_time_step.h"

#include <fmt/format.h>

#include <algorithm>

namespace app
{
namespace
{
std::string scheme_text(const solver::Numerics& n)
{
    const bool total = n.formulation == solver::Formulation::total;
    const std::string transfer = n.transfer == solver::Transfer::nodal  ? "motion kept on the nodes"
                                 : n.transfer == solver::Transfer::apic ? "APIC"
                                 : n.pic_fraction > 0 ? fmt::format("FLIP with {} PIC", n.pic_fraction)
                                                      : "FLIP";
    const std::string basis = n.basis == solver::Basis::trilinear ? "trilinear basis"
                              : total ? "trilinear basis (gimp was asked for: the same at rest positions)"
                                      : "basis gimp: boxes of constant size, cut by the cells they touch";
    return fmt::format("{} Lagrangian, {}, {}, stress update {}", total ? "total" : "updated", basis, transfer,
                       n.stress_update == solver::StressUpdate::musl ? "from velocities mapped again (MUSL)"
                                                                     : "last (USL)");
}

std::string onset_text(const material::Material& m)
{
    const material::Decohesion& law = *m.decohesion;
    if (law.nonlocal_radius > 0)
        return fmt::format("{}: onset on the mean stress of a ball of radius {} mm; {}", m.name, law.nonlocal_radius,
                           law.crack_exclusion > 0
                               ? fmt::format("no parallel crack plane within {} mm", law.crack_exclusion)
                               : std::string("no rule against parallel crack planes"));
    return fmt::format("{}: onset on {} (changes with the cell size where plastic strain localises)", m.name,
                       law.smoothed_onset ? "the mean stress of the cell" : "the particle's own stress");
}

std::string cracks_text(const material::Material& m, const solver::State& state)
{
    std::size_t count[3] = {0, 0, 0}, crossed = 0;
    Real snap_back = 0;
    for (const core::Crack& crack : state.particles.cracks) {
        ++count[std::clamp(crack.mode - 1, 0, 2)];
        crossed += crack.second_time >= 0 ? 1 : 0;
        snap_back = std::max(snap_back, crack.snap_back_ratio);
    }
    if (state.particles.cracks.empty())
        return fmt::format("{}: decohesion, no particle has started to separate", m.name);
    return fmt::format(
        "{}: decohesion; {} particles in opening, {} in shear, {} in mixed mode; largest L_e / L_crit {:.3g} "
        "({}){}",
        m.name, count[0], count[1], count[2], snap_back,
        m.decohesion->snap_back == material::SnapBack::brittle_drop ? "brittle drop beyond 1"
                                                                    : "fracture energy raised to the floor beyond 1",
        m.decohesion->second_crack ? fmt::format("; {} crossed by a second crack", crossed) : "");
}
} // namespace

std::vector<std::string> modelled(const solver::Problem& problem, const solver::State& state)
{
    std::vector<std::string> text;
    text.push_back(scheme_text(problem.numerics));
    text.push_back(problem.grid.levels == 1
                       ? std::string("one level")
                       : fmt::format("{} levels, finer in {} zone(s): {} slave nodes at the interfaces",
                                     problem.grid.levels, problem.zones.size(), [&] {
                                         std::size_t slaves = 0;
                                         for (const auto& face : state.levels.interface) slaves += face.slave.size();
                                         return slaves;
                                     }()));
    if (problem.numerics.subcycling)
        text.push_back(
            fmt::format("sub-cycling: a step of the coarsest level is {} of the finest", solver::substeps(problem)));
    if (const solver::Numerics& n = problem.numerics; n.damping > 0)
        text.push_back(fmt::format("damping of {} 1/ms, of {}", n.damping,
                                   n.damps_fast_motion_only()
                                       ? fmt::format("what is faster than a mean over {} ms", n.damping_memory)
                                       : std::string("all motion")));
    for (const solver::SymmetryPlane& plane : problem.symmetry)
        text.push_back(fmt::format("half model: symmetry plane {} = {} mm", "xyz"[plane.axis], plane.at));
    text.push_back(problem.grid.edge == solver::EdgeTreatment::staircase
                       ? "cut cells: particles in or out by their centre (staircase)"
                       : "cut cells: particle volumes scaled by the part inside the body");
    for (const material::Material& m : problem.materials) {
        text.push_back(
            fmt::format("{}: {}{}", m.name, m.plastic ? "von Mises, linear hardening" : "elastic",
                        m.plastic && m.cell_averaged_dilatation ? ", cell-averaged dilatation against locking" : ""));
        if (m.decohesion) text.push_back(onset_text(m));
        if (m.decohesion) text.push_back(cracks_text(m, state));
    }
    return text;
}
} // namespace app
