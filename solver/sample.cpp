#include "solver/sample.h"

#include "solver/audit.h"
#include "solver/external_force.h"
#include "solver/nodal.h"
#include "solver/quantity_values.h"

#include <limits>

namespace solver
{
namespace
{
template <class... F>
struct Overloaded : F...
{
    using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

Real value_of(const LoadQuantity& quantity, const Problem& problem, const Derived& derived, const State& state)
{
    const int axis = quantity.component;
    if (quantity.on_surface)
        return quantity.what == LoadQuantity::What::force
                   ? surface_force(problem, derived, quantity.load, axis, state.clock.time)
                   : std::numeric_limits<Real>::quiet_NaN();
    const LoadState& load = state.loads[quantity.load];
    switch (quantity.what) {
    case LoadQuantity::What::force:
        return load.sample_time > 0 ? problem.symmetry_factor(axis) * load.sample_impulse[axis] / load.sample_time
                                    : std::numeric_limits<Real>::quiet_NaN(); // a mean over no time
    case LoadQuantity::What::displacement:
        return load.displacement[axis];
    case LoadQuantity::What::work:
        break;
    }
    return load.external_work;
}

bool needs_ledger(const Quantity& quantity)
{
    const auto* crack = std::get_if<CrackQuantity>(&quantity.kind);
    return std::holds_alternative<Energy>(quantity.kind) || (crack && crack->what == CrackQuantity::What::energy);
}

bool needs_columns(const Quantity& quantity)
{
    return !std::holds_alternative<Energy>(quantity.kind) && !std::holds_alternative<LoadQuantity>(quantity.kind) &&
           !std::holds_alternative<CrackQuantity>(quantity.kind) && !std::holds_alternative<Ratio>(quantity.kind);
}
} // namespace

const Sample& take_sample(const Problem& problem, const Prepared& prepared, const Derived& derived, State& state)
{
    const auto any = [&](bool (*needs)(const Quantity&)) {
        return std::any_of(problem.quantities.begin(), problem.quantities.end(), needs);
    };
    const Ledger ledger = any(needs_ledger) ? audit(prepared, state) : Ledger{};
    std::optional<OutputColumns> columns;
    if (any(needs_columns)) columns.emplace(state);
    const ParticleView view{state.particles, state.levels, prepared.per_axis};

    Sample sample{state.clock.step, state.clock.time, {}};
    for (const Quantity& quantity : problem.quantities)
        sample.value.push_back(std::visit(
            Overloaded{
                [&](const Energy& kind) { return value_of(kind, ledger); },
                [&](const LoadQuantity& kind) { return value_of(kind, problem, derived, state); },
                [&](const FieldError& kind) { return value_of(kind, problem, state.clock, view); },
                [&](const CrackQuantity& kind) {
                    return kind.what == CrackQuantity::What::energy
                               ? ledger.decohesion
                               : value_of(kind, problem.materials, state.particles);
                },
                [&](const Ratio&) { return std::numeric_limits<Real>::quiet_NaN(); }, // of results, not of values
                [&](const auto& kind) { return value_of(kind, view); },
            },
            quantity.kind));
    for (LoadState& load : state.loads) {
        load.sample_impulse.setZero();
        load.sample_time = 0;
    }
    return state.samples.emplace_back(std::move(sample));
}
} // namespace solver
