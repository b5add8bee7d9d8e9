#include "io/point_file.h"

#include "material/decohesion.h"

#include <fmt/format.h>

#include <iterator>

namespace io
{
namespace
{
constexpr std::string_view header =
    "step,time_ms,strain_xx,strain_yy,strain_zz,strain_xy,strain_yz,strain_zx,"
    "stress_xx_MPa,stress_yy_MPa,stress_zz_MPa,stress_xy_MPa,stress_yz_MPa,stress_zx_MPa,"
    "eq_plastic_strain,damage,mode,opening_mm,slip_x_mm,slip_y_mm,slip_z_mm,normal_x,normal_y,normal_z,"
    "normal_traction_MPa,shear_traction_MPa,plastic_mJ_per_mm3,decohesion_mJ_per_mm3,decohesion_N_per_mm,"
    "acoustic_ratio\n";

/// Digits enough to see rounding, few enough that no noise of it shows.
void put(std::string& out, Real value)
{
    fmt::format_to(std::back_inserter(out), ",{:.10g}", value + 0.0); // + 0 makes -0 a 0
}
} // namespace

std::string point_csv(const std::vector<solver::PointState>& history)
{
    std::string out(header);
    for (const solver::PointState& state : history) {
        const core::Crack crack = state.crack.value_or(core::Crack{});
        const material::PlaneTraction traction = material::plane_traction(state.stress, {crack.normal});
        fmt::format_to(std::back_inserter(out), "{}", state.step);
        put(out, state.time);
        for (const Real value : state.strain.s) put(out, value);
        for (const Real value : state.stress.s) put(out, value);
        put(out, state.eq_plastic_strain);
        put(out, crack.damage);
        fmt::format_to(std::back_inserter(out), ",{}", crack.mode);
        put(out, crack.opening);
        for (const Real value : crack.slip) put(out, value);
        for (const Real value : crack.normal) put(out, value);
        for (const Real value : {traction.normal, traction.shear, state.plastic_work, state.decohesion_work,
                                 state.decohesion_work * crack.effective_length, state.acoustic_ratio})
            put(out, value);
        out += '\n';
    }
    return out;
}
} // namespace io
