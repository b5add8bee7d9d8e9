/// Keys of the files of `cleave chart` (a suite) and `cleave sweep`; columns as in io/key_table.cpp.
#include "io/keys.h"

#include <array>

namespace io
{
namespace
{
using enum Type;
using enum Presence;
using enum Range;
namespace dim = dimension;

constexpr std::array keys{
    Key{"suite", "title", text, defaulted, "\"\"", "one line for the page"},
    Key{"suite", "include", names, optional, "", "file or files to read first, relative to this one; this file wins"},
    Key{"suite", "axis", table, optional, "", "settings to vary together: [[axis]]"},
    Key{"suite", "scene", table, required, "", "cases whose answer is known: [[scene]]"},
    Key{"suite.axis", "name", text, required, "", "for the products of the scenes"},
    Key{"suite.axis", "resolution", boolean, defaulted, "false",
        "its settings are cell sizes or levels of one scheme, not other schemes"},
    Key{"suite.axis", "setting", table, required, "", "its settings: [[axis.setting]]"},
    Key{"suite.axis.setting", "label", text, required, "", "short, for pictures and tables"},
    Key{"suite.axis.setting", "set", names, defaulted, "[]",
        "overrides key=value as for --set; none: the case as it is"},
    Key{"suite.scene", "name", text, required, "", "of its pictures and of its directory"},
    Key{"suite.scene", "title", text, defaulted, "\"\"", "over its picture; default: that of the case"},
    Key{"suite.scene", "case", text, required, "", "case file, relative to the suite"},
    Key{"suite.scene", "measure", text, required, "",
        "number of run.json: an error, such as errors.u, or with `reference` a measure, such as measures.peak_force_N"},
    Key{"suite.scene", "reference", real, optional, "",
        "its right value: the error is |measure - reference| / |reference|"},
    Key{"suite.scene", "stable", table, optional, "", "criterion a usable run must meet: { measure, below }"},
    Key{"suite.scene", "set", names, defaulted, "[]", "overrides for every run of the scene"},
    Key{"suite.scene", "axis", table, optional, "",
        "[[scene.axis]]: axes of this scene, instead of one of the suite with the same name"},
    Key{"suite.scene", "products", values, required, "",
        "lists of axes, such as [[\"scheme\", \"resolution\"], [\"particles\"]]: every combination of the settings of "
        "each"},
    Key{"suite.scene", "length", real, optional, "",
        "what the cells have to resolve; default: smallest hole, else smallest side of the bodies", dim::length,
        positive},
    Key{"suite.scene", "limit", wall_time, defaulted, "\"10 min\"", "processor time after which a run is given up",
        dim::time, positive},
    Key{"suite.scene.stable", "measure", text, required, "", "number of run.json"},
    Key{"suite.scene.stable", "below", real, required, "", "largest magnitude of a stable run", {}, positive},

    Key{"sweep", "title", text, defaulted, "\"\"", "one line for the table"},
    Key{"sweep", "include", names, optional, "", "file or files to read first, relative to this one; this file wins"},
    Key{"sweep", "case", text, required, "", "case file, relative to the sweep"},
    Key{"sweep", "set", names, defaulted, "[]", "overrides for every run"},
    Key{"sweep", "threads", integer, defaulted, "1", "of each run", {}, positive},
    Key{"sweep", "limit", wall_time, optional, "", "processor time after which a run is given up", dim::time, positive},
    Key{"sweep", "reference", text, optional, "", "name of a [[reference]] of the case: its measures are targets"},
    Key{"sweep", "target", table, optional, "", "measures to come near to: [[target]]"},
    Key{"sweep", "vary", table, optional, "", "keys to vary, every combination: [[vary]]"},
    Key{"sweep", "run", table, optional, "", "listed runs instead of combinations: [[run]]"},
    Key{"sweep.vary", "key", text, required, "", "dotted key of the case, such as material.steel.decohesion.s_max"},
    Key{"sweep.vary", "values", values, required, "", "its values"},
    Key{"sweep.run", "label", text, required, "", "name of the run and of its directory"},
    Key{"sweep.run", "set", names, required, "", "overrides key=value as for --set"},
    Key{"sweep.target", "measure", text, required, "", "measure of run.json, such as peak_force_N"},
    Key{"sweep.target", "value", real, optional, "", "wanted value; absent: that of `reference`"},
    Key{"sweep.target", "weight", real, defaulted, "1", "of its relative error in the distance", {}, non_negative},
};
} // namespace

std::span<const Key> study_keys()
{
    return keys;
}
} // namespace io
