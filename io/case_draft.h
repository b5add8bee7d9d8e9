/// A case while it is being read: the Problem so far, where its parts came from, and the complaints.
///
/// Each read_* function reads one kind of section (files case_*.cpp), in the order read_case calls them: shapes may
/// name features, loads and ligaments too. Parts with errors stay in the Problem but are not `sound`; checks skip them.
#pragma once

#include "io/section_reader.h"
#include "solver/problem.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace io
{
/// Where a part of the Problem was written, and whether it was read without errors.
struct Origin
{
    Place place;
    bool sound = false;
};

struct Draft
{
    Draft(const Node& case_root, Diagnostics& complaints) : root(case_root), diagnostics(complaints) {}

    const Node& root;
    Diagnostics& diagnostics;
    solver::Problem problem;
    Node resolved;

    Origin grid, end, gauge;
    // Same order as the vectors of Problem.
    std::vector<Origin> materials, bodies, features, zones, symmetry, loads, surface_loads;
    Place every_cod; // first interval by opening; file < 0: none
};

struct ReadShape
{
    std::optional<geometry::Shape> shape; // nothing after an error
    Node resolved;
};

/// @param path  of the key that holds it, such as "body.shape"
ReadShape read_shape(Draft& draft, const Node& value, const std::string& path);
/// The shape at a key of a section, recorded there; "everything" after an error or if absent.
geometry::Shape read_shape(Draft& draft, SectionReader& section, std::string_view key);
/// Straight hole without end.
geometry::Shape round_hole(const Vec3& centre, int axis, Real radius);

void read_grid(Draft& draft);
void read_materials(Draft& draft);
void read_motions(Draft& draft);
void read_features(Draft& draft);
void read_bodies(Draft& draft);
void read_zones(Draft& draft);
void read_symmetry(Draft& draft);
void read_loads(Draft& draft);
void read_gauge(Draft& draft);
void read_forces(Draft& draft);
void read_ligaments(Draft& draft);
void read_crack(Draft& draft);
void read_references(Draft& draft);
void read_numerics(Draft& draft);
void read_end(Draft& draft);
void read_output(Draft& draft);
void read_quantities(Draft& draft);

/// What only the parts together can tell: zones outside bodies, planes off the nodes, pins in the void.
void check_case(Draft& draft);

/// The feature of that name, or an error at `place` and null.
const solver::Feature* find_feature(Draft& draft, const std::string& name, const Place& place);

/// The material of that name, or an error at `place` and null.
const material::Material* find_material(Draft& draft, const std::string& name, const Place& place);
/// Its index, or an error at `place` and 0.
int material_index(Draft& draft, const std::string& name, const Place& place);
/// Index of the motion named at a key of a section; empty if the key is absent or (with an error) names none.
std::optional<int> find_motion(Draft& draft, SectionReader& section, std::string_view key);

/// An error for a name that is not in the list, with the nearest one that is.
void unknown_name(Draft& draft, const Place& place, std::string_view kind, std::string_view name,
                  const std::vector<std::string>& candidates);

/// Visit the tables of an array [[name]] in order; an error if it is something else.
void for_each_item(Draft& draft, const Node* list, const std::string& name,
                   const std::function<void(const Node& item)>& visit);

/// Read the tables of [kind.NAME] in order. Errors of one that overrides begin but do not complete become one: its name
/// is misspelt. Without another of that kind they stay: there is nothing that could be meant.
void for_each_named(Draft& draft, const Node& table, std::string_view kind,
                    const std::function<void(const Entry& entry)>& read);

/// Put a section into the resolved tree: [path] for tables, one more [[path]] for arrays of tables.
void keep(Draft& draft, const std::vector<std::string>& path, Node section);
void keep_item(Draft& draft, const std::vector<std::string>& path, Node section);
} // namespace io
