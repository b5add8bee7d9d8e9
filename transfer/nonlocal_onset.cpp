#include "transfer/nonlocal_onset.h"

#include "core/parallel.h"
#include "material/decohesion.h"
#include "transfer/nonlocal_cracks.h"
#include "transfer/nonlocal_stress.h"

#include <algorithm>

namespace transfer
{
namespace
{
/// Append the materials of a cell of which an intact particle is near a strength.
void append_near(const NonlocalView& view, const particles::Particles& particles, std::size_t slot,
                 std::vector<Candidate>& candidates)
{
    const std::size_t first = candidates.size();
    for (std::uint32_t p = view.levels.cell_start[slot]; p < view.levels.cell_start[slot + 1]; ++p) {
        const std::uint8_t material = particles.material[p];
        const material::Decohesion* law = particles.crack[p] < 0 ? nonlocal_law(view.laws, material) : nullptr;
        if (!law) continue;
        const bool known = std::any_of(candidates.begin() + static_cast<std::ptrdiff_t>(first), candidates.end(),
                                       [&](const Candidate& other) { return other.material == material; });
        if (known || !material::may_start(*law, stress_of(view, particles, p))) continue;
        candidates.push_back({slot, material});
    }
}

/// Cells near onset, by leaf; the nodal scheme has noted them on its way.
std::vector<Candidate> near_onset(const NonlocalView& view, const particles::Particles& particles)
{
    std::vector<std::vector<Candidate>> found(view.levels.leaves.size());
    core::parallel_for(found.size(), [&](std::size_t leaf) {
        if (view.lattice.in_use()) {
            for (const int cell : view.lattice.near[leaf])
                append_near(view, particles, leaf * grid::leaf_cells + static_cast<std::size_t>(cell), found[leaf]);
        } else {
            for (std::size_t cell = 0; cell < grid::leaf_cells; ++cell)
                append_near(view, particles, leaf * grid::leaf_cells + cell, found[leaf]);
        }
    });
    std::vector<Candidate> all;
    for (const std::vector<Candidate>& leaf : found) all.insert(all.end(), leaf.begin(), leaf.end());
    return all;
}

/// Balls that are not in the table yet.
void complete_table(const NonlocalView& view, const particles::Particles& particles,
                    const std::vector<Candidate>& candidates, NonlocalTable& table)
{
    std::vector<Candidate> missing;
    for (const Candidate& candidate : candidates)
        if (!table.ball.contains(key_of(candidate))) missing.push_back(candidate);
    std::vector<Ball> balls(missing.size());
    core::parallel_for(missing.size(), [&](std::size_t n) { balls[n] = ball_of(view, particles, missing[n]); });
    for (std::size_t n = 0; n < missing.size(); ++n) table.ball.emplace(key_of(missing[n]), std::move(balls[n]));
}

/// Cracks of the cell's intact particles, empty if a neighbour forbids them.
std::vector<Onset> cracks_of(const NonlocalView& view, const particles::Particles& particles,
                             const Candidate& candidate)
{
    const material::Material& material = view.laws.materials[candidate.material];
    const material::Decohesion& law = *material.decohesion;
    const CellMotion motion = motion_of(view, particles, candidate.slot);
    const std::vector<Neighbour> neighbours =
        cracks_near(view, particles, candidate.slot, std::max(law.nonlocal_radius, law.crack_exclusion));
    material::Bias bias{motion.velocity_gradient, {}};
    const auto nearest =
        std::min_element(neighbours.begin(), neighbours.end(), [](const Neighbour& a, const Neighbour& b) {
            return a.offset.squaredNorm() < b.offset.squaredNorm();
        });
    if (nearest != neighbours.end()) bias.preferred_normal = {nearest->normal};

    const Real spacing = view.levels.spacing(view.levels.leaves[candidate.slot / grid::leaf_cells].level);
    std::vector<Onset> onset;
    for (std::uint32_t p = view.levels.cell_start[candidate.slot]; p < view.levels.cell_start[candidate.slot + 1]; ++p)
    {
        if (particles.crack[p] >= 0 || particles.material[p] != candidate.material) continue;
        auto crack = material::onset(law, material.elastic, candidate.tested, stress_of(view, particles, p), bias,
                                     spacing, view.options.time, candidate.lode);
        if (!crack) continue;
        crack->particle_id = particles.id[p];
        onset.push_back({p, *crack});
    }
    if (onset.empty() || candidate.overloaded) return onset;
    const core::Crack& fresh = onset.front().crack; // all have one plane: the tested stress and the bias are the cell's
    const Vec3 normal = at_rest(motion.deformation, fresh.normal);
    for (const Neighbour& other : neighbours)
        if (excluded(other.offset, at_rest(motion.deformation, other.normal), normal,
                     std::max(fresh.effective_length, other.effective_length), law.crack_exclusion) &&
            softens(view, particles, other.slot))
            return {};
    return onset;
}

bool goes_first(const Candidate& a, const Candidate& b)
{
    if (a.excess != b.excess) return a.excess > b.excess;
    return key_of(a) < key_of(b);
}
} // namespace

int nonlocal_interval(const LawTable& laws, Real dt)
{
    Real fastest = 0;
    for (const LawConstants& c : laws.constants) fastest = std::max(fastest, c.wave_speed);
    return std::max(1, static_cast<int>(std::min(laws.nonlocal_radius / (fastest * dt), Real(1000))));
}

std::size_t start_nonlocal_cracks(const PassOptions& options, const LawTable& laws, const grid::Levels& levels,
                                  Lattice& lattice, particles::Particles& particles, NonlocalTable& table)
{
    if (lattice.in_use() && table.place.empty()) table.place = lattice_places(lattice, particles.size());
    const NonlocalView view{options, laws, levels, lattice, table};
    std::vector<Candidate> candidates = near_onset(view, particles);
    if (candidates.empty()) return 0;
    if (options.formulation == Formulation::total) complete_table(view, particles, candidates, table);
    core::parallel_for(candidates.size(), [&](std::size_t n) { choose_tested(view, candidates[n], particles); });

    std::erase_if(candidates, [](const Candidate& candidate) { return candidate.excess <= 1; });
    std::sort(candidates.begin(), candidates.end(), goes_first);
    std::size_t started = 0;
    for (const Candidate& candidate : candidates)
        for (const Onset& onset : cracks_of(view, particles, candidate)) {
            record(onset, particles); // before the next candidate looks for cracks beside it
            if (lattice.in_use()) lattice.cracked[candidate.slot] = 1;
            ++started;
        }
    return started;
}
} // namespace transfer
