/// `cleave check CASE`: errors, warnings, and what the run will cost.
#include "app/bytes_text.h"
#include "app/commands.h"
#include "app/forecast.h"
#include "app/hardware_threads.h"
#include "io/case.h"
#include "io/process_memory.h"
#include "solver/stable_time_step.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <memory>

namespace app
{
namespace
{
struct Options
{
    std::string file;
    std::vector<std::string> overrides;
    int threads = 0;
};

std::string duration_text(Real seconds)
{
    if (seconds < 90) return fmt::format("{:.0f} s", std::max(Real(1), seconds));
    if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
    return fmt::format("{:.1f} h", seconds / 3600);
}

int terminal_columns()
{
    const char* text = std::getenv("COLUMNS");
    const int columns = text ? std::atoi(text) : 0;
    return columns > 20 ? columns - 2 : 78;
}

void print_forecast(const solver::Problem& problem, const Forecast& forecast, int threads)
{
    std::string levels;
    for (std::size_t l = 0; l < forecast.particles.size(); ++l)
        levels += fmt::format("{}level {} ({} mm): {}", l == 0 ? "" : ", ", l,
                              problem.grid.cell / static_cast<Real>(1 << l), forecast.particles[l]);
    fmt::print("particles    {}; {}{}\n", forecast.total_particles(), levels,
               forecast.estimated ? "; estimated from volumes" : "");
    const auto available = static_cast<Real>(io::machine_bytes());
    fmt::print("memory       {}{}\n", bytes_text(forecast.memory),
               forecast.memory > available ? fmt::format(", more than the {} of this machine", bytes_text(available))
                                           : std::string());
    fmt::print("time step    {:.4g} ms at the start{}\n", forecast.dt,
               problem.numerics.subcycling ? fmt::format(", of the finest level; of the coarsest {:.4g} ms",
                                                         solver::substeps(problem) * forecast.dt)
                                           : std::string());
    if (std::isfinite(forecast.end_time)) {
        fmt::print("steps        {:.0f} to t = {:.4g} ms\n", forecast.steps, forecast.end_time);
        const Real rate = assumed_steps_per_s(problem.numerics);
        fmt::print(
            "wall time    {} on {} thread{}, assuming {:.0f} million particle-steps/s per thread (`cleave bench` "
            "measures it)\n",
            duration_text(forecast.particle_steps / (rate * threads)), threads, threads == 1 ? "" : "s", rate / 1e6);
        fmt::print("output       {:.0f} particle frames, {}; {:.0f} grid frames, {}; {:.0f} volumes, {}\n",
                   forecast.particle_frames, bytes_text(forecast.particle_bytes), forecast.grid_frames,
                   bytes_text(forecast.grid_bytes), forecast.vdb_frames, bytes_text(forecast.vdb_bytes));
    } else {
        fmt::print("steps        not known: the case ends by an opening whose speed no load prescribes\n");
    }
    if (forecast.kinetic_share > 0)
        fmt::print("inertia      kinetic energy about {:.2g} % of the elastic energy at yield{}\n",
                   100 * forecast.kinetic_share,
                   forecast.kinetic_share > 0.05 ? ": slower loading or a longer ramp would show less of it" : "");
}

int check(const Options& options)
{
    const io::Case read = io::read_case_with_warnings(options.file, options.overrides);
    for (const std::string& warning : read.warnings) fmt::print("{}\n", warning);
    const solver::Problem& problem = read.problem;
    fmt::print("{}: {}\n", options.file, problem.title.empty() ? "no title" : problem.title);
    print_forecast(problem, forecast(problem), options.threads > 0 ? options.threads : hardware_threads());
    fmt::print("levels in the middle plane, '.' void\n{}", level_map(problem, terminal_columns()));
    fmt::print("no errors, {} warning{}\n", read.warnings.size(), read.warnings.size() == 1 ? "" : "s");
    return 0;
}
} // namespace

void add_check(CLI::App& program, Command& chosen)
{
    CLI::App* command = program.add_subcommand("check", "Validate a case and forecast what it costs");
    const auto options = std::make_shared<Options>();
    command->add_option("CASE", options->file, "case file")->required();
    command->add_option("--set", options->overrides, "key=value, such as grid.cell=0.5; may be repeated")
        ->allow_extra_args(false);
    command->add_option("--threads", options->threads, "threads to forecast for")->check(CLI::Range(1, 1024));
    command->callback([&chosen, options] { chosen = [options] { return check(*options); }; });
}
} // namespace app
