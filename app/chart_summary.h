/// What a chart says about one scene, in numbers.
#pragma once

#include "io/chart_file.h"

#include <optional>
#include <string>
#include <vector>

namespace app
{
struct SceneSummary
{
    std::string scene;
    std::size_t settings = 0;       // rows, without those that do not apply
    std::size_t crosses = 0;        // failed, unstable, over the limit, not reached
    std::size_t not_applicable = 0; // combinations that do not go together
    std::size_t pending = 0;
    Real default_error = io::ChartRow::none, default_cpu_s = io::ChartRow::none;
    Real default_over_front = io::ChartRow::none; // 1: on the front
    std::optional<Real> order;            // of the default scheme: error ~ h^order over its uniform or nested rows
    std::optional<Real> two_level_factor; // processor time of one level over that of several, at equal error
    bool beyond_one_level = false;        // several levels reached an error that one level did not
};

/// Scenes in the order of the rows.
std::vector<SceneSummary> summarise(const std::vector<io::ChartRow>& rows);

/// Least-squares slope of log(error) over log(h); nothing with fewer than two different h.
std::optional<Real> fitted_order(const std::vector<Real>& h, const std::vector<Real>& error);

/// Same method, whatever its resolution: all columns of numerics and the particles per cell.
bool same_method(const io::ChartRow& a, const io::ChartRow& b);

/// Factor of processor time by which several levels beat one at equal error, geometric mean over the several-level rows
/// of the schemes (method and other settings) that were run both ways; one level's cost at an error between two of its
/// front points by log-log interpolation. Nothing where the ranges do not meet; `beyond` is set when several levels
/// went further down.
std::optional<Real> two_level_factor(const std::vector<io::ChartRow>& scene, bool& beyond);
} // namespace app
