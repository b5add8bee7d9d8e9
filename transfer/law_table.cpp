#include "transfer/law_table.h"

#include "material/decohesion.h"

#include <algorithm>

namespace transfer
{
LawTable law_table(const std::vector<material::Material>& materials)
{
    LawTable table;
    table.materials = materials;
    for (const material::Material& m : materials) {
        LawConstants c;
        c.lame = m.elastic.lame();
        c.wave_speed = m.elastic.wave_speed();
        c.shear = m.elastic.shear_modulus();
        if (m.plastic) {
            c.yield = m.plastic->yield_stress;
            c.hardening = m.plastic->plastic_modulus(m.elastic.youngs_modulus);
        }
        c.per_overstress = 1 / (3 * c.shear + c.hardening);
        if (m.decohesion) {
            c.tensile_onset = m.decohesion->s_max;
            c.shear_onset = material::least_shear_strength(*m.decohesion);
            table.any_decohesion = true;
            const Real radius = m.decohesion->nonlocal_radius;
            if (radius > 0)
                table.nonlocal_radius = table.nonlocal_radius > 0 ? std::min(table.nonlocal_radius, radius) : radius;
        }
        c.averaged_dilatation = m.cell_averaged_dilatation;
        table.constants.push_back(c);
        table.separation.push_back(m.decohesion ? material::separation_law(m) : material::SeparationLaw{});
    }
    return table;
}
} // namespace transfer
