/// Which settings meet a wanted error at the lowest cost, from what a chart has measured on scenes of like features.
///
/// A method (all of [numerics], particles per cell, one level or several) has on each charted scene errors at some
/// resolutions x = finest cell / length of the scene. A wanted error e asks for the largest measured x from which on
/// every finer run met e; where none did, x is extrapolated from the finest run with the fitted order. The method is
/// taken at the smallest x its like scenes ask for, so that it would have met e on each of them; its cost is the
/// forecast of the case at that x times the processor time per particle-step the method took in the chart.
///
/// A like scene that no method at all comes to e with, neither measured nor extrapolated, is left out and named: its
/// reference is further off than e (an experiment, say), and tells no method from another.
#pragma once

#include "app/scene_features.h"
#include "io/chart_file.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace app
{
/// What one charted scene says about a method.
struct Evidence
{
    std::string scene;
    int distance = 0;          // of its features from those of the case
    Real resolution = 0;       // x it asks for
    std::optional<Real> order; // fitted; nothing: one resolution only
    bool measured = false;     // or extrapolated
};

struct Advice
{
    io::ChartRow method;          // its columns of numerics
    std::vector<std::string> set; // overrides of the case
    Real resolution = 0;          // x taken, after rounding to cells that fit the case
    Real finest_mm = 0;
    Real cpu_s = 0;         // s, expected
    Real charted_error = 0; // largest error of the like scenes at this x
    std::vector<Evidence> evidence;
    std::vector<std::string> silent; // like scenes that no method comes that near with: they say nothing
    bool own_scene = false;          // the case itself is in the chart
};

struct Advised
{
    std::optional<Advice> advice; // nothing: no charted method is expected to meet the error
    Real asked_mm = 0;            // then the coarsest cell a method would meet it with, if no grid of that can be had
    Real length_mm = 0;           // what the cells have to resolve
};

struct AdviceRequest
{
    std::filesystem::path file;
    std::vector<std::string> overrides; // of the case
    Real error = 0;                     // 1, relative
    std::optional<Real> length;         // mm; nothing: as scene_features finds it
    std::vector<std::string> without;   // scenes of the chart to leave out
};

/// 0 for equal features; contact and large motion decide which methods work at all and weigh most.
int feature_distance(const SceneFeatures& a, const io::ChartRow& b);

/// What the rows of one scene and method say; nothing if the method did not get there: its finest run failed, or its
/// error does not fall with the cell.
std::optional<Evidence> evidence_of(const std::vector<const io::ChartRow*>& rows, Real error);

/// Cells of a grid that a machine can hold: beyond, nothing is counted and nothing advised.
inline constexpr Real most_cells = 3e6;

/// The cheapest settings expected to meet the error.
///
/// @error core::InputError of the case
Advised advise(const AdviceRequest& request, const std::vector<io::ChartRow>& rows);

/// The advice as a fragment of a case file with the reasons as comments.
std::string advice_text(const AdviceRequest& request, const Advice& advice);
} // namespace app
