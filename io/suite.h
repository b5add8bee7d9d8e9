/// Suites of `cleave chart`: scenes whose answer is known, and the settings to run them with.
#pragma once

#include "core/real.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace io
{
/// One choice: overrides as for --set, with a short name.
struct Setting
{
    std::string label;
    std::vector<std::string> set;
};

struct Axis
{
    std::string name;
    bool resolution = false; // settings are finer and coarser, not other schemes
    std::vector<Setting> settings;
};

/// Every combination of one setting of each axis, the last axis fastest, begun with T{}.
/// @param add  (T& begun, const Axis&, const Setting&)
template <class T, class Add>
std::vector<T> combinations(const std::vector<Axis>& axes, Add add)
{
    std::vector<T> all(1);
    for (const Axis& axis : axes) {
        std::vector<T> longer;
        for (const T& begun : all)
            for (const Setting& setting : axis.settings) add(longer.emplace_back(begun), axis, setting);
        all = std::move(longer);
    }
    return all;
}

/// A run is stable if |number| stays below a bound.
struct StabilityCriterion
{
    std::string measure; // dotted, of run.json
    Real below = 0;
};

struct Scene
{
    std::string name;
    std::string title;
    std::filesystem::path file;    // the case
    std::string measure;           // dotted, of run.json
    std::optional<Real> reference; // the measure's right value; none: the measure is an error already
    std::optional<StabilityCriterion> stable;
    std::vector<std::string> set;            // overrides of every run
    std::vector<std::vector<Axis>> products; // every combination of the settings of each list of axes
    std::optional<Real> length;              // mm, to be resolved by cells
    Real limit = 0;                          // s, processor time of a run
};

struct Suite
{
    std::string title;
    std::vector<Scene> scenes;
};

/// @error core::InputError with the text of every error; core::FileError if `file` cannot be read
Suite read_suite(const std::filesystem::path& file);
} // namespace io
