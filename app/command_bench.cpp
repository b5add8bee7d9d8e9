/// `cleave bench`: throughput of the whole step beside what this machine can do at most.
#include "app/bench_block.h"
#include "app/choice_name.h"
#include "app/commands.h"
#include "app/hardware_threads.h"
#include "core/error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace app
{
namespace
{
struct Options
{
    bool json = false;
    int cells = 50;
    int steps = 15;
    std::vector<int> threads;
    std::string basis, formulation, stress_update, transfer, precision; // only schemes with these names, if not empty
};

const std::vector<BenchCase>& schemes()
{
    using enum solver::Formulation;
    using enum solver::StressUpdate;
    using enum solver::Transfer;
    using enum solver::Precision;
    using enum solver::Basis;
    static const std::vector<BenchCase> list{
        {total, usl, nodal, mixed, 1},       {total, usl, nodal, mixed, 2},     {total, usl, nodal, f64, 1},
        {total, usl, nodal, f64, 2},         {total, usl, flip, f64, 1},        {total, usl, flip, f64, 2},
        {total, musl, flip, f64, 1},         {total, usl, apic, f64, 1},        {updated, usl, flip, f64, 1},
        {updated, musl, flip, f64, 1},       {updated, usl, apic, f64, 1},      {updated, usl, flip, f64, 1, gimp},
        {updated, musl, flip, f64, 1, gimp}, {updated, usl, apic, f64, 1, gimp}};
    return list;
}

bool wanted(const BenchCase& scheme, const Options& options)
{
    const auto fits = [](const std::string& word, const std::string& own) { return word.empty() || word == own; };
    return fits(options.basis, choice_name("basis", scheme.basis)) &&
           fits(options.formulation, choice_name("formulation", scheme.formulation)) &&
           fits(options.stress_update, choice_name("stress_update", scheme.stress_update)) &&
           fits(options.transfer, choice_name("transfer", scheme.transfer)) &&
           fits(options.precision, choice_name("precision", scheme.precision));
}

nlohmann::json entry(const BenchResult& r)
{
    return {{"basis", choice_name("basis", r.scheme.basis)},
            {"formulation", choice_name("formulation", r.scheme.formulation)},
            {"stress_update", choice_name("stress_update", r.scheme.stress_update)},
            {"transfer", choice_name("transfer", r.scheme.transfer)},
            {"precision", choice_name("precision", r.scheme.precision)},
            {"levels", r.scheme.levels},
            {"threads", r.threads},
            {"particles", r.particles},
            {"particle_steps_per_s", r.particle_steps_per_s},
            {"bytes_per_particle_step", r.bytes_per_particle_step},
            {"flops_per_particle_step", r.flops_per_particle_step},
            {"roof_share", r.roof_share},
            {"triad_GBs", r.limits.triad_bytes_per_s / 1e9},
            {"fma_GFs", r.limits.fma_flops_per_s / 1e9}};
}

int bench(const Options& options)
{
    if (std::none_of(schemes().begin(), schemes().end(), [&](const BenchCase& one) { return wanted(one, options); }))
        throw core::InputError(
            "there is no scheme with all of these; `cleave bench` without them shows which there are");
    std::vector<int> threads = options.threads;
    if (threads.empty()) {
        threads.push_back(1);
        if (hardware_threads() > 1) threads.push_back(hardware_threads());
    }
    nlohmann::json all = nlohmann::json::array();
    for (const int t : threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(t));
        if (!options.json)
            fmt::print(
                "{} thread{}\n{:<9} {:<9} {:<5} {:<5} {:<5} {:>6} {:>10} {:>10} {:>7} {:>10} {:>6} {:>6} {:>6}\n", t,
                t == 1 ? "" : "s", "basis", "form.", "upd.", "tran.", "prec.", "levels", "particles", "M steps/s",
                "B/step", "flop/step", "GB/s", "GF/s", "roof");
        for (const BenchCase& scheme : schemes()) {
            if (!wanted(scheme, options)) continue;
            const BenchResult r = bench_block(scheme, options.cells, options.steps, t);
            all.push_back(entry(r));
            if (options.json) continue;
            fmt::print(
                "{:<9} {:<9} {:<5} {:<5} {:<5} {:>6} {:>10} {:>10.1f} {:>7.0f} {:>10.0f} {:>6.1f} {:>6.0f} {:>5.0f}%\n",
                choice_name("basis", r.scheme.basis), choice_name("formulation", r.scheme.formulation),
                choice_name("stress_update", r.scheme.stress_update), choice_name("transfer", r.scheme.transfer),
                choice_name("precision", r.scheme.precision), r.scheme.levels, r.particles,
                r.particle_steps_per_s / 1e6, r.bytes_per_particle_step, r.flops_per_particle_step,
                r.limits.triad_bytes_per_s / 1e9, r.limits.fma_flops_per_s / 1e9, 100 * r.roof_share);
            std::fflush(stdout);
        }
    }
    if (!options.json) fmt::print("GB/s: triad; GF/s: multiply-adds in double; roof: share of the nearer limit\n");
    if (options.json) fmt::print("{}\n", all.dump(2));
    return 0;
}
} // namespace

void add_bench(CLI::App& program, Command& chosen)
{
    CLI::App* command =
        program.add_subcommand("bench", "Measure the throughput of the step beside the machine's limits");
    const auto options = std::make_shared<Options>();
    command->add_flag("--json", options->json, "one array of objects instead of a table");
    command->add_option("--cells", options->cells, "cells per side of the block (default 50: a million particles)")
        ->check(CLI::Range(4, 200));
    command->add_option("--steps", options->steps, "steps measured per scheme, in five rounds; the median counts")
        ->check(CLI::Range(1, 10000));
    command->add_option("--threads", options->threads, "thread counts (default: 1 and all)")
        ->check(CLI::Range(1, 1024));
    command->add_option("--basis", options->basis, "only schemes of this basis")
        ->check(CLI::IsMember({"trilinear", "gimp"}));
    command->add_option("--formulation", options->formulation, "only schemes of this formulation")
        ->check(CLI::IsMember({"total", "updated"}));
    command->add_option("--stress-update", options->stress_update, "only schemes with this stress update")
        ->check(CLI::IsMember({"usl", "musl"}));
    command->add_option("--transfer", options->transfer, "only schemes with this transfer")
        ->check(CLI::IsMember({"flip", "apic", "nodal"}));
    command->add_option("--precision", options->precision, "only schemes with this precision")
        ->check(CLI::IsMember({"f64", "mixed"}));
    command->callback([&chosen, options] { chosen = [options] { return bench(*options); }; });
}
} // namespace app
