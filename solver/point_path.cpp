#include "solver/point_path.h"

#include "core/error.h"
#include "material/rotation.h"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace solver
{
namespace
{
constexpr int most_iterations = 50;
constexpr int most_halvings = 12;
constexpr Real difference = 1e-8; // 1, strain of the tangent: between rounding of the stress and curvature of the law

/// Where a step shall end.
struct Target
{
    std::vector<int> free;  // components that are stress-controlled
    core::Sym<Real> stress; // MPa, of the free components
    PointStep step;         // strain of the others is final
};

Eigen::VectorXd residual(const Target& target, const PointState& state)
{
    Eigen::VectorXd r(static_cast<Eigen::Index>(target.free.size()));
    for (Eigen::Index k = 0; const int i : target.free) r[k++] = state.stress[i] - target.stress[i];
    return r;
}

void add(const Target& target, const Eigen::VectorXd& change, core::Sym<Real>& strain)
{
    for (Eigen::Index k = 0; const int i : target.free) strain[i] += change[k++];
}

Eigen::MatrixXd tangent(const PointLaw& law, const PointState& before, const Target& target, const PointStep& step,
                        const Eigen::VectorXd& at)
{
    Eigen::MatrixXd slope(at.size(), at.size());
    for (Eigen::Index k = 0; const int i : target.free) {
        PointStep moved = step;
        moved.strain[i] += difference;
        slope.col(k++) = (residual(target, advance(law, before, moved)) - at) / difference;
    }
    return slope;
}

/// Strain that would end the step on its target if the point stayed elastic.
PointStep elastic_guess(const PointLaw& law, const PointState& before, const Target& target)
{
    PointStep step = target.step;
    const core::Sym<Real> turned = core::rotated(material::incremental_rotation(step.rotation), before.stress);
    const core::Sym<Real> trial =
        material::elastic_trial(turned, material::at_end_of_step(step.strain, step.rotation), law.lame);
    const auto count = static_cast<Eigen::Index>(target.free.size());
    Eigen::VectorXd missing(count);
    Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(count, count);
    for (Eigen::Index k = 0; k < count; ++k) {
        const int i = target.free[static_cast<std::size_t>(k)];
        missing[k] = target.stress[i] - trial[i];
        for (Eigen::Index l = 0; l < count; ++l)
            if (i < 3 && target.free[static_cast<std::size_t>(l)] < 3) stiffness(k, l) = law.lame.lame;
        stiffness(k, k) += law.lame.shear_two;
    }
    add(target, stiffness.ldlt().solve(missing), step.strain);
    return step;
}

[[noreturn]] void throw_no_balance(const Target& target, const PointState& before, const PointState& closest)
{
    const Eigen::VectorXd r = residual(target, closest);
    Eigen::Index worst = 0;
    (void)r.cwiseAbs().maxCoeff(&worst);
    const std::string_view name =
        component_names[static_cast<std::size_t>(target.free[static_cast<std::size_t>(worst)])];
    const int component = target.free[static_cast<std::size_t>(worst)];
    std::string why = "the yield surface may not reach that far: prescribe a strain instead";
    if (before.crack && before.crack->damage >= 1)
        why = "the crack is through and carries no tension: prescribe the strain that opens it";
    else if (before.crack)
        why = fmt::format("the point softens (damage {:.3g}), and softening under prescribed stress has no solution: "
                          "prescribe the strain that opens or shears the crack",
                          before.crack->damage);
    const Real digit = 1e-9 * std::abs(target.stress[component]); // MPa; what is less is rounding
    const Real found = std::abs(closest.stress[component]) < digit ? Real(0) : closest.stress[component];
    throw core::NumericalError(
        fmt::format("no strain gives stress {} = {:.6g} MPa at step {}; the closest found is {:.6g} MPa\n{}", name,
                    target.stress[component], before.step + 1, found, why));
}

/// The state at the end of a step whose free strains balance the prescribed stresses.
PointState balanced(const PointLaw& law, const PointState& before, const Target& target)
{
    if (target.free.empty()) return advance(law, before, target.step);
    const Real tolerance = 1e-12 * law.material.elastic.youngs_modulus; // MPa
    PointStep step = elastic_guess(law, before, target);
    PointState state = advance(law, before, step);
    Eigen::VectorXd r = residual(target, state);
    for (int i = 0; i < most_iterations && !(r.cwiseAbs().maxCoeff() <= tolerance); ++i) {
        // Least squares of least norm: an open crack has no stiffness at all in some directions.
        const Eigen::VectorXd change = tangent(law, before, target, step, r).completeOrthogonalDecomposition().solve(r);
        Real share = 1;
        for (int halvings = 0;; ++halvings, share /= 2) {
            PointStep tried = step;
            add(target, -share * change, tried.strain);
            const PointState there = advance(law, before, tried);
            const Eigen::VectorXd left = residual(target, there);
            if (left.norm() < r.norm()) {
                step = tried;
                state = there;
                r = left;
                break;
            }
            if (halvings == most_halvings) throw_no_balance(target, before, state);
        }
    }
    if (!(r.cwiseAbs().maxCoeff() <= tolerance)) throw_no_balance(target, before, state);
    return state;
}

/// The n-th of the segment's steps, n from 1, for a point that began the segment in `begin` and is in `now`.
Target target_of(const PointSegment& segment, std::int64_t n, const PointState& begin, const PointState& now)
{
    const Real done = static_cast<Real>(n) / static_cast<Real>(segment.steps);
    Target target{};
    for (int i = 0; i < 6; ++i)
        if (const std::optional<Real>& strain = segment.strain[static_cast<std::size_t>(i)])
            // From the present strain, not by equal increments: the last step ends on the target to rounding.
            target.step.strain[i] = begin.strain[i] + done * (*strain - begin.strain[i]) - now.strain[i];
        else {
            target.free.push_back(i);
            target.stress[i] = begin.stress[i] + done * (segment.stress[i] - begin.stress[i]);
        }
    target.step.rotation = (1 / static_cast<Real>(segment.steps)) * segment.rotation;
    return target;
}
} // namespace

void follow(const PointPath& path, const std::function<void(const PointState&)>& visit)
{
    const PointLaw law = point_law(path.material, path.spacing);
    PointState state;
    visit(state);
    for (const PointSegment& segment : path.segments) {
        const PointState begin = state;
        for (std::int64_t n = 1; n <= segment.steps; ++n) {
            Target target = target_of(segment, n, begin, state);
            target.step.dt = path.step_time;
            state = balanced(law, state, target);
            visit(state);
        }
    }
}
} // namespace solver
