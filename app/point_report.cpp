#include "app/point_report.h"

#include "app/svg_chart.h"
#include "core/equivalent_stress.h"
#include "material/decohesion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app
{
namespace
{
using History = std::vector<solver::PointState>;

/// The component whose strain changes most over the path.
int main_component(const History& history)
{
    const auto range = [&](int i) {
        double low = 0, high = 0;
        for (const solver::PointState& state : history) {
            low = std::min(low, state.strain[i]);
            high = std::max(high, state.strain[i]);
        }
        return high - low;
    };
    int found = 0;
    for (int i = 1; i < 6; ++i)
        if (range(i) > range(found) * (1 + 1e-9)) found = i;
    return found;
}

template <class X, class Y>
ChartSeries series(const History& history, const char* label, const char* colour, X x, Y y)
{
    ChartSeries out{label, colour, ChartSeries::Mark::line, {}, {}};
    for (const solver::PointState& state : history) {
        out.x.push_back(x(state));
        out.y.push_back(y(state));
    }
    return out;
}

double slip(const core::Crack& crack)
{
    return std::sqrt(core::dot(core::Vec<double>{crack.slip}, core::Vec<double>{crack.slip}));
}

Chart traction_chart(const History& history)
{
    History cracked;
    for (const solver::PointState& state : history)
        if (state.crack) cracked.push_back(state);
    const auto traction = [](const solver::PointState& state) {
        return material::plane_traction(state.stress, {state.crack->normal});
    };
    return {"opening or slip (mm)",
            "traction (MPa)",
            {series(
                 cracked, "normal over opening", "#1f77b4", [](auto& state) { return state.crack->opening; },
                 [&](auto& state) { return traction(state).normal; }),
             series(
                 cracked, "shear over slip", "#d62728", [](auto& state) { return slip(*state.crack); },
                 [&](auto& state) { return traction(state).shear; })}};
}

std::string policy_text(const material::Decohesion& law, double floor, double ratio)
{
    if (law.snap_back == material::SnapBack::brittle_drop)
        return ratio >= 1 ? fmt::format("brittle drop over {:g} transits of L_e", law.drop_transits)
                          : "brittle drop, not needed: L_e < L_crit";
    return floor > 1 ? fmt::format("energy floor: G_f raised {:.4g} times", floor)
                     : "energy floor, not needed: L_e is short enough";
}

/// Energy per crack area [N/mm] that a drop of the tractions at constant strain releases: L_e sum tau_i^2 / (2 Q_i).
double stored_energy(const material::Material& material, const core::Crack& crack)
{
    const auto [normal, shear] = crack.drop_traction;
    return 0.5 * crack.effective_length *
           (normal * normal / material.elastic.wave_modulus() + shear * shear / material.elastic.shear_modulus());
}

std::string crack_text(const material::Material& material, const solver::PointState& end)
{
    constexpr std::array<const char*, 4> modes{"none", "opening", "shear", "mixed"};
    const material::Decohesion& law = *material.decohesion;
    const core::Crack& crack = *end.crack;
    const double ratio = crack.snap_back_ratio;
    const bool floors = law.snap_back == material::SnapBack::energy_floor;
    const double floor = floors ? std::max(1.0, law.energy_floor_factor * ratio) : 1.0;
    const double used = material::fracture_energy(law.q, crack),
                 dissipated = end.decohesion_work * crack.effective_length;
    std::string text = fmt::format("onset        step {}, t = {:.6g} ms, mode {}\n", end.onset_step, crack.onset_time,
                                   modes[static_cast<std::size_t>(crack.mode)]);
    text += fmt::format("normal       [{:.4f}, {:.4f}, {:.4f}] at the end\n", crack.normal[0] + 0.0,
                        crack.normal[1] + 0.0, crack.normal[2] + 0.0);
    text += fmt::format("strengths    tau_nf {:.6g} MPa, tau_tf {:.6g} MPa\n", crack.normal_strength,
                        crack.tangential_strength);
    text += fmt::format("lengths      L_e {:.6g} mm, L_crit {:.6g} mm, snap-back ratio B_s {:.4g}\n",
                        crack.effective_length, crack.effective_length / ratio, ratio);
    text += fmt::format("policy       {}\n", policy_text(law, floor, ratio));
    text += fmt::format("dissipated   {:.6g} N/mm by the crack; ", dissipated);
    if (!floors && ratio >= 1)
        text += fmt::format("stored at onset {:.6g} N/mm, G_f of the case {:.6g} N/mm\n",
                            stored_energy(material, crack), used);
    else
        text += fmt::format("G_f of the case {:.6g} N/mm, used {:.6g} N/mm\n", used / floor, used);
    std::string separated = crack.damage >= 1 ? fmt::format(", separated at t = {:.6g} ms", crack.separation_time) : "";
    if (crack.second_time >= 0)
        separated += fmt::format(", crossed by a second crack at t = {:.6g} ms", crack.second_time);
    return text + fmt::format("end          damage {:.4g}, opening {:.6g} mm, slip {:.6g} mm{}\n", crack.damage,
                              crack.opening, slip(crack), separated);
}
} // namespace

std::string point_charts(const History& history)
{
    const int i = main_component(history);
    const std::string name(solver::component_names[static_cast<std::size_t>(i)]);
    const auto strain = [i](const solver::PointState& state) { return state.strain[i]; };
    std::vector<Chart> charts{
        {"strain " + name,
         "stress (MPa)",
         {series(history, "component", "#1f77b4", strain, [i](auto& state) { return state.stress[i]; }),
          series(history, "von Mises", "#999999", strain,
                 [](auto& state) { return core::equivalent_stress(state.stress); })}},
        {"strain " + name,
         "damage, eq. plastic strain",
         {series(history, "damage", "#d62728", strain,
                 [](auto& state) { return state.crack ? state.crack->damage : 0.0; }),
          series(history, "eq. plastic strain", "#2ca02c", strain,
                 [](auto& state) { return state.eq_plastic_strain; })}}};
    charts.front().series.front().label = "stress " + name;
    if (history.back().crack) charts.push_back(traction_chart(history));
    return svg_charts(charts);
}

std::string point_summary(const solver::PointPath& path, const History& history)
{
    const solver::PointState& end = history.back();
    const auto largest = std::max_element(history.begin(), history.end(), [](const auto& a, const auto& b) {
        return core::equivalent_stress(a.stress) < core::equivalent_stress(b.stress);
    });
    std::string text = fmt::format("steps        {} of {:.4g} ms, cell {:g} mm, material {}\n", end.step,
                                   path.step_time, path.spacing, path.material.name);
    text += fmt::format("von Mises    largest {:.6g} MPa at step {}\n", core::equivalent_stress(largest->stress),
                        largest->step);
    text += fmt::format("plastic      strain {:.6g}, work {:.6g} mJ/mm^3\n", end.eq_plastic_strain, end.plastic_work);
    return text + (end.crack                  ? crack_text(path.material, end)
                   : path.material.decohesion ? "onset        none: the strengths hold\n"
                                              : "onset        none: the material has no decohesion\n");
}
} // namespace app
