#include "io/case_draft.h"

#include <fmt/format.h>

namespace io
{
namespace
{
using Shapes = std::vector<geometry::Shape>;

Node inlined(Node table)
{
    table.section = false;
    return table;
}

struct ReadShapes
{
    std::optional<Shapes> shapes;
    Node resolved;
};

ReadShapes read_shapes(Draft& draft, const Node& value, const std::string& path)
{
    if (value.kind != Node::Kind::list || value.items.empty()) {
        draft.diagnostics.error(value.place, fmt::format("'{}' takes a list of at least one shape", path));
        return {};
    }
    Shapes shapes;
    std::vector<Node> resolved;
    for (const Node& item : value.items) {
        ReadShape read = read_shape(draft, item, path);
        if (read.shape) shapes.push_back(*read.shape);
        resolved.push_back(std::move(read.resolved));
    }
    if (shapes.size() != value.items.size()) return {};
    return {std::move(shapes), list_of(std::move(resolved))};
}

/// Reads one kind: a section of schema "shape.<kind>" becomes a shape; empty if a value is unusable.
using Maker = std::optional<geometry::Shape> (*)(Draft&, SectionReader&);

std::optional<geometry::Shape> make_box(Draft&, SectionReader& section)
{
    const Vec3 lower = section.vector("lower"), upper = section.vector("upper");
    if (!section.sound()) return std::nullopt;
    if ((lower.array() < upper.array()).all()) return geometry::box(lower, upper);
    section.error("upper", "a box needs upper > lower in every component");
    return std::nullopt;
}

std::optional<geometry::Shape> make_sphere(Draft&, SectionReader& section)
{
    const Vec3 centre = section.vector("centre");
    const Real radius = section.real("radius");
    if (!section.sound()) return std::nullopt;
    return geometry::sphere(centre, radius);
}

std::optional<geometry::Shape> make_cylinder(Draft&, SectionReader& section)
{
    const Vec3 from = section.vector("from"), to = section.vector("to");
    const Real radius = section.real("radius");
    if (!section.sound()) return std::nullopt;
    if (from != to) return geometry::cylinder(from, to, radius);
    section.error("to", "a cylinder needs two different ends");
    return std::nullopt;
}

std::optional<geometry::Shape> make_half_space(Draft&, SectionReader& section)
{
    const Vec3 point = section.vector("point"), normal = section.vector("normal");
    if (!section.sound()) return std::nullopt;
    if (normal.norm() > 0) return geometry::half_space(point, normal);
    section.error("normal", "a half space needs a normal that is not zero");
    return std::nullopt;
}

std::optional<geometry::Shape> make_polygon(Draft&, SectionReader& section)
{
    const std::vector<Pair> corners = section.corners("corners");
    const int axis = section.axis("axis");
    const Real lower = section.real("lower"), upper = section.real("upper");
    if (!section.sound()) return std::nullopt;
    if (lower < upper) return geometry::extruded_polygon(corners, axis, lower, upper);
    section.error("upper", "a polygon needs upper > lower along its axis");
    return std::nullopt;
}

geometry::Shape through_tube(std::vector<Vec3> points, Real radius, std::optional<int> axis)
{
    if (!axis) return geometry::tube(points, radius);
    for (Vec3& point : points) point[*axis] = 0;
    return geometry::extended(geometry::tube(points, radius), *axis, 0);
}

std::optional<geometry::Shape> make_tube(Draft&, SectionReader& section)
{
    const std::vector<Vec3> points = section.points("points");
    const Real radius = section.real("radius");
    const std::optional<int> axis = section.optional_axis("axis");
    if (!section.sound()) return std::nullopt;
    return through_tube(points, radius, axis);
}

std::optional<geometry::Shape> make_difference(Draft& draft, SectionReader& section)
{
    std::optional<geometry::Shape> from;
    std::optional<Shapes> holes;
    if (const Node* value = section.find("from")) {
        ReadShape read = read_shape(draft, *value, section.path() + ".from");
        from = read.shape;
        section.record("from", std::move(read.resolved));
    } else
        section.error("from", "a difference needs 'from' = a shape");
    if (const Node* value = section.find("holes")) {
        ReadShapes read = read_shapes(draft, *value, section.path() + ".holes");
        holes = read.shapes;
        section.record("holes", std::move(read.resolved));
    } else
        section.error("holes", "a difference needs 'holes' = a list of shapes");
    if (!from || !holes) return std::nullopt;
    return geometry::subtract(*from, *holes);
}

struct Kind
{
    std::string_view name;
    Maker make; // null: not a table of its own, read below
};

constexpr Kind kinds[] = {
    {"box", make_box},
    {"sphere", make_sphere},
    {"cylinder", make_cylinder},
    {"half_space", make_half_space},
    {"polygon", make_polygon},
    {"tube", make_tube},
    {"difference", make_difference},
    {"union", nullptr},
    {"intersection", nullptr},
    {"feature", nullptr},
    {"polyline", nullptr},
};

std::optional<geometry::Shape> read_polyline(Draft& draft, SectionReader& section)
{
    const std::vector<std::string> names = section.names("polyline");
    if (!section.has("radius")) {
        section.error("polyline", "a polyline needs a radius", "add radius = 2.0");
        return std::nullopt;
    }
    const Real radius = section.real("radius");
    const std::optional<int> axis = section.optional_axis("axis");
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (const auto* feature = find_feature(draft, names[i], section.find("polyline")->items[i].place))
            points.push_back(feature->centre);
    if (points.empty() && section.sound()) section.error("polyline", "a polyline needs at least one feature");
    if (!section.sound()) return std::nullopt;
    return through_tube(points, radius, axis);
}

std::optional<geometry::Shape> read_kind(Draft& draft, SectionReader& section, const Kind& kind)
{
    const Node& value = *section.find(kind.name);
    const std::string path = fmt::format("{}.{}", section.path(), kind.name);
    if (kind.make) {
        SectionReader own(draft.diagnostics, &value, fmt::format("shape.{}", kind.name), path, value.place);
        std::optional<geometry::Shape> shape = kind.make(draft, own);
        own.finish();
        section.record(kind.name, inlined(own.resolved()));
        return shape;
    }
    if (kind.name == "polyline") return read_polyline(draft, section);
    if (kind.name == "feature") {
        const std::string name = section.text("feature");
        const solver::Feature* feature = section.sound() ? find_feature(draft, name, value.place) : nullptr;
        return feature ? std::optional(feature->shape) : std::nullopt;
    }
    ReadShapes read = read_shapes(draft, value, path);
    section.record(kind.name, std::move(read.resolved));
    if (!read.shapes) return std::nullopt;
    return kind.name == "union" ? geometry::unite(*read.shapes) : geometry::intersect(*read.shapes);
}
} // namespace

ReadShape read_shape(Draft& draft, const Node& value, const std::string& path)
{
    if (value.kind != Node::Kind::table) {
        draft.diagnostics.error(value.place, fmt::format("'{}' must be a shape", path),
                                "expected a table such as { sphere = { centre = [0, 0, 0], radius = 1 } }");
        return {};
    }
    SectionReader section(draft.diagnostics, &value, "shape", path, value.place);
    section.finish();
    const Kind* found = nullptr;
    int count = 0;
    for (const Kind& kind : kinds)
        if (section.has(kind.name)) {
            found = &kind;
            ++count;
        }
    if (count != 1) {
        std::vector<std::string> names;
        for (const Kind& kind : kinds) names.emplace_back(kind.name);
        if (section.sound())
            draft.diagnostics.error(value.place, fmt::format("'{}' must name exactly one kind of shape", path), "",
                                    {fmt::format("kinds: {}     (cleave keys shape)", joined(names))});
        return {};
    }
    if (found->name != "polyline" && (section.has("radius") || section.has("axis")))
        section.error(
            section.has("radius") ? "radius" : "axis",
            fmt::format("'radius' and 'axis' beside the kind belong to a polyline, not to '{}'", found->name));
    std::optional<geometry::Shape> shape = read_kind(draft, section, *found);
    return {section.sound() ? shape : std::nullopt, inlined(section.resolved())};
}

geometry::Shape read_shape(Draft& draft, SectionReader& section, std::string_view key)
{
    const Node* value = section.find(key);
    if (!value) {
        section.error(key, fmt::format("missing key '{}' in [{}]", key, section.path()),
                      "expected a shape such as { sphere = { centre = [0, 0, 0], radius = 1 } }");
        return {};
    }
    ReadShape read = read_shape(draft, *value, fmt::format("{}.{}", section.path(), key));
    section.record(key, std::move(read.resolved));
    return read.shape.value_or(geometry::Shape());
}

geometry::Shape round_hole(const Vec3& centre, int axis, Real radius)
{
    return geometry::extended(geometry::sphere(centre, radius), axis, centre[axis]);
}
} // namespace io
