// The verification scenes of cases/verification from their case files: largest error at the finest resolution and the
// least ratio of errors when the cells are halved (methods.md A.5: order 2 is a ratio of 4), by scheme.
#include "tests/support/case_run.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

namespace
{
using Overrides = std::vector<std::string>;

struct Row
{
    const char* name;
    Overrides scheme;
    Real largest_error; // at the finest
    Real least_ratio;   // from one resolution to the next
};

const Overrides nodal{}, mixed{"numerics.precision=mixed"}, total_flip{"numerics.transfer=flip"},
    total_apic{"numerics.transfer=apic"}, gimp_flip{"numerics.formulation=updated", "numerics.basis=gimp"},
    gimp_apic{"numerics.formulation=updated", "numerics.basis=gimp", "numerics.transfer=apic"},
    updated_flip{"numerics.formulation=updated"};

void converges(const std::string& file, const std::string& measure, const std::vector<Real>& cells, const Row& row,
               const std::function<Overrides(Real)>& more = {})
{
    Real before = 0;
    for (const Real cell : cells) {
        Overrides overrides = row.scheme;
        overrides.push_back(fmt::format("grid.cell={}", cell));
        if (more)
            for (const std::string& text : more(cell)) overrides.push_back(text);
        const Real error = support::results_of(file, overrides).at(measure);
        if (before > 0) {
            EXPECT_GT(before / error, row.least_ratio) << file << ", " << row.name << ": " << before << ' ' << error;
        }
        before = error;
    }
    EXPECT_LT(before, row.largest_error) << file << ", " << row.name;
}
} // namespace

TEST(Scenes, c1_box_wave)
{
    for (const Row& row : {Row{"nodal", nodal, 1, 1}, Row{"mixed", mixed, 1, 1}, Row{"total flip", total_flip, 1, 1},
                           Row{"total apic", total_apic, 1, 1}, Row{"gimp flip", gimp_flip, 1, 1}})
        converges("c1-box-wave/case.toml", "displacement_l2", {0.25, 0.125, 0.0625}, row);
}
