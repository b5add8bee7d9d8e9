#include "io/case.h"

#include "core/error.h"
#include "io/case_draft.h"

namespace io
{
namespace
{
void read_top(Draft& draft)
{
    SectionReader section(draft.diagnostics, &draft.root, "", "", draft.root.place);
    (void)section.choice<int>("units");
    draft.problem.title = section.text("title");
    draft.problem.gravity = section.vector("gravity");
    section.finish();
    for (const Entry& entry : section.resolved().entries) keep(draft, {entry.key}, entry.value);
}

void read_sections(Draft& draft)
{
    read_top(draft);
    read_grid(draft);
    read_materials(draft);
    read_motions(draft);
    read_features(draft);
    read_bodies(draft);
    read_zones(draft);
    read_symmetry(draft);
    read_loads(draft);
    read_gauge(draft);
    read_forces(draft);
    read_ligaments(draft);
    read_crack(draft);
    read_numerics(draft);
    read_end(draft);
    read_output(draft);
    read_quantities(draft);
    read_references(draft);
}
} // namespace

Case read_case_with_warnings(const std::filesystem::path& file, const std::vector<std::string>& overrides)
{
    Diagnostics diagnostics;
    const Node root = load_document(file, overrides, diagnostics);
    if (const Node* point = root.find("point"))
        diagnostics.error(point->place, "[point] makes this the case of a material point", "use `cleave point`");
    // After a syntax error half the file is missing: everything else would only be noise.
    if (diagnostics.error_count() > 0) throw core::InputError(diagnostics.error_text());

    Draft draft(root, diagnostics);
    read_sections(draft);
    check_case(draft);
    if (diagnostics.error_count() > 0) throw core::InputError(diagnostics.error_text());
    return {std::move(draft.problem), diagnostics.warning_texts(), write_document(draft.resolved)};
}

solver::Problem read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides)
{
    return read_case_with_warnings(file, overrides).problem;
}

std::vector<std::optional<Complaint>> complaints_of_keys(const std::filesystem::path& file,
                                                         const std::vector<std::string>& overrides)
{
    Diagnostics diagnostics;
    const Node root = load_document(file, overrides, diagnostics);
    Draft draft(root, diagnostics);
    read_sections(draft);
    // Every override is a source of its own, after those of the files.
    const std::size_t first = diagnostics.source_count() - overrides.size();
    std::vector<std::optional<Complaint>> complaints;
    for (std::size_t i = 0; i < overrides.size(); ++i) complaints.push_back(diagnostics.key_error_in(first + i));
    return complaints;
}
} // namespace io
