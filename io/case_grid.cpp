#include "io/case_draft.h"

#include <fmt/format.h>

namespace io
{
void read_grid(Draft& draft)
{
    SectionReader section(draft.diagnostics, draft.root.find("grid"), "grid", "grid", draft.root.place);
    solver::Grid& grid = draft.problem.grid;
    grid.cell = section.real("cell");
    grid.levels = section.integer("levels");
    grid.particles_per_cell = section.integer("particles_per_cell");
    grid.origin = section.vector("origin");
    grid.edge = section.choice<solver::EdgeTreatment>("edge");
    if (grid.levels > 8)
        section.error("levels", fmt::format("{} levels are more than the grid holds", grid.levels), "at most 8");
    section.finish();
    draft.grid = {section.place(), section.sound()};
    keep(draft, {"grid"}, section.resolved());
}

void read_zones(Draft& draft)
{
    const Node* refine = draft.root.find("refine");
    if (!refine) return;
    if (const Node* criteria = refine->find("criterion"))
        draft.diagnostics.error(criteria->place, "refinement by criteria is not in this version",
                                "use fixed zones: [[refine.zone]]");
    Node without_criteria = *refine;
    std::erase_if(without_criteria.entries, [](const Entry& entry) { return entry.key == "criterion"; });
    SectionReader(draft.diagnostics, &without_criteria, "refine", "refine", refine->place).finish();
    for_each_item(draft, refine->find("zone"), "refine.zone", [&](const Node& item) {
        SectionReader section(draft.diagnostics, &item, "refine.zone", "refine.zone", item.place);
        solver::Zone zone;
        zone.name = section.text("name");
        zone.shape = read_shape(draft, section, "shape");
        zone.level = section.integer("level");
        zone.margin = section.real("margin");
        if (zone.name.empty()) zone.name = fmt::format("zone {}", draft.problem.zones.size());
        section.record("name", node(std::string_view(zone.name)));
        // Of two levels they may be one refined twice.
        for (const solver::Zone& other : draft.problem.zones)
            if (other.name == zone.name && other.level == zone.level)
                section.error("name", fmt::format("there are two zones '{}' of level {}", zone.name, zone.level));
        if (draft.grid.sound && section.sound() && zone.level > draft.problem.grid.levels - 1)
            section.error("level",
                          fmt::format("zone '{}' asks for level {}, but the finest is {}", zone.name, zone.level,
                                      draft.problem.grid.levels - 1),
                          fmt::format("levels count from 0: set grid.levels = {} for it", zone.level + 1));
        section.finish();
        draft.zones.push_back({section.place("shape"), section.sound()});
        draft.problem.zones.push_back(std::move(zone));
        keep_item(draft, {"refine", "zone"}, section.resolved());
    });
}
} // namespace io
