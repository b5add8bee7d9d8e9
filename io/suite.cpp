#include "io/suite.h"

#include "core/error.h"
#include "io/study_sections.h"

#include <fmt/format.h>

#include <algorithm>

namespace io
{
namespace
{
std::vector<std::string> names_of(const std::vector<Axis>& axes)
{
    std::vector<std::string> names;
    for (const Axis& axis : axes) names.push_back(axis.name);
    return names;
}

/// @param path  "axis" or "scene.axis": both have the same keys
Axis read_axis(Diagnostics& diagnostics, const Node& item, const std::string& path)
{
    SectionReader section(diagnostics, &item, "suite.axis", path, item.place);
    Axis axis;
    axis.name = section.text("name");
    axis.resolution = section.boolean("resolution", false);
    if (!section.has("setting"))
        section.error("setting", fmt::format("axis '{}' has no settings", axis.name),
                      fmt::format("add [[{}.setting]] tables", path));
    std::vector<std::string> seen;
    for_each_table(diagnostics, section.find("setting"), path + ".setting", [&](const Node& one) {
        SectionReader inner(diagnostics, &one, "suite.axis.setting", path + ".setting", one.place);
        Setting setting{inner.text("label"), read_overrides(diagnostics, inner, "set")};
        check_unique(diagnostics, inner.place("label"), "setting", setting.label, seen);
        inner.finish();
        axis.settings.push_back(std::move(setting));
    });
    section.finish();
    return axis;
}

std::vector<Axis> read_axes(Diagnostics& diagnostics, const Node* list, const std::string& path)
{
    std::vector<Axis> axes;
    std::vector<std::string> seen;
    for_each_table(diagnostics, list, path, [&](const Node& item) {
        axes.push_back(read_axis(diagnostics, item, path));
        check_unique(diagnostics, item.place, "axis", axes.back().name, seen);
    });
    return axes;
}

/// The axes of one product, those of the scene first.
std::vector<Axis> named_axes(Diagnostics& diagnostics, const Node& product, const std::vector<Axis>& known)
{
    std::vector<Axis> axes;
    if (product.kind != Node::Kind::list) {
        diagnostics.error(product.place, "a product is a list of axes", "such as [\"scheme\", \"resolution\"]");
        return axes;
    }
    for (const Node& name : product.items) {
        const auto found = std::find_if(known.begin(), known.end(), [&](const Axis& a) { return a.name == name.text; });
        if (name.kind == Node::Kind::text && found != known.end())
            axes.push_back(*found);
        else
            diagnostics.error(name.place, fmt::format("there is no axis '{}'", name.text),
                              nearest_hint(name.text, names_of(known)),
                              {fmt::format("axes here: {}", joined(names_of(known)))});
    }
    return axes;
}

std::optional<StabilityCriterion> read_stable(Diagnostics& diagnostics, const Node* table)
{
    if (!table) return std::nullopt;
    SectionReader section(diagnostics, table, "suite.scene.stable", "scene.stable", table->place);
    StabilityCriterion criterion{section.text("measure"), section.real("below")};
    section.finish();
    return criterion;
}

Scene read_scene(Diagnostics& diagnostics, const Node& item, const std::filesystem::path& file,
                 const std::vector<Axis>& shared)
{
    SectionReader section(diagnostics, &item, "suite.scene", "scene", item.place);
    Scene scene;
    scene.name = section.text("name");
    scene.title = section.text("title");
    scene.file = case_beside(section, file);
    scene.measure = section.text("measure");
    scene.reference = section.optional_real("reference");
    if (scene.reference && *scene.reference == 0)
        section.error("reference", "an error relative to 0 has no meaning", "use a measure that is an error itself");
    scene.stable = read_stable(diagnostics, section.find("stable"));
    scene.set = read_overrides(diagnostics, section, "set");
    scene.length = section.optional_real("length");
    scene.limit = section.real("limit");
    std::vector<Axis> axes = read_axes(diagnostics, section.find("axis"), "scene.axis");
    for (const Axis& axis : shared)
        if (std::none_of(axes.begin(), axes.end(), [&](const Axis& own) { return own.name == axis.name; }))
            axes.push_back(axis);
    const Node* products = section.find("products");
    if (!products)
        section.error("products", fmt::format("scene '{}' has no products", scene.name),
                      "expected products = [[\"axis\", ...], ...]");
    else if (products->kind != Node::Kind::list)
        type_error(*products, key_of("suite.scene", "products"), diagnostics);
    else
        for (const Node& product : products->items) scene.products.push_back(named_axes(diagnostics, product, axes));
    section.finish();
    return scene;
}
} // namespace

Suite read_suite(const std::filesystem::path& file)
{
    Diagnostics diagnostics;
    const Node root = load_document(file, {}, diagnostics);
    if (diagnostics.error_count() > 0) throw core::InputError(diagnostics.error_text());
    SectionReader section(diagnostics, &root, "suite", "", root.place);
    Suite suite;
    suite.title = section.text("title");
    const std::vector<Axis> axes = read_axes(diagnostics, root.find("axis"), "axis");
    if (!section.has("scene")) section.error("scene", "the suite has no scene", "add [[scene]] tables");
    std::vector<std::string> seen;
    for_each_table(diagnostics, root.find("scene"), "scene", [&](const Node& item) {
        suite.scenes.push_back(read_scene(diagnostics, item, file, axes));
        check_unique(diagnostics, item.place, "scene", suite.scenes.back().name, seen);
    });
    section.finish();
    if (diagnostics.error_count() > 0) throw core::InputError(diagnostics.error_text());
    return suite;
}
} // namespace io
