#include "transfer/nonlocal_onset.h"

#include "core/parallel.h"
#include "material/decohesion.h"
#include "particles/tensors.h"
#include "transfer/chunk.h"
#include "transfer/middle_gradient.h"

#include <algorithm>
#include <optional>

namespace transfer
{
namespace
{
constexpr Real rounding = 1e-6; // 1, of comparisons between places on the lattice

/// What the phase reads, bundled for its stages.
struct View
{
    const PassOptions& options;
    const LawTable& laws;
    const grid::Levels& levels;
    const Lattice& lattice;
    const NonlocalTable& table;
};

/// A cell and material that may start, with the stress it is tested on.
struct Candidate
{
    std::size_t slot = 0;
    std::uint8_t material = 0;
    core::Sym<Real> tested{}; // MPa, mean of its ball or of the cell
    Real excess = 0;          // 1, largest ratio of stress to strength; <= 1: the criterion is not met
    bool overloaded = false;  // its own mean is beyond `overload`: starts whatever stands beside it
};

core::Sym<Real> stress_of(const View& view, const particles::Particles& particles, std::uint32_t p)
{
    if (!view.lattice.in_use()) return particles::stress_of(particles, p);
    return std::visit(
        [&]<class T>(const BlockTable<T>& blocks) {
            const std::size_t place = view.table.place[p];
            const std::size_t lane = place % block_lanes<T>, row = place / block_lanes<T>;
            const BlockState<T>& state = blocks.state[row / slots];
            core::Sym<Real> stress{};
            for (std::size_t n = 0; n < 6; ++n) stress.s[n] = static_cast<Real>(state.stress[n][row % slots][lane]);
            return stress;
        },
        view.lattice.blocks);
}

std::vector<std::uint32_t> lattice_places(const Lattice& lattice, std::size_t count)
{
    std::vector<std::uint32_t> places(count);
    std::visit(
        [&]<class T>(const BlockTable<T>& blocks) {
            for (std::size_t b = 0; b < blocks.block.size(); ++b)
                for (int s = 0; s < slots; ++s)
                    for (int i = 0; i < blocks.block[b].count; ++i)
                        if (blocks.block[b].has(i, s))
                            places[blocks.block[b].particle(i, s)] =
                                static_cast<std::uint32_t>((b * slots + static_cast<std::size_t>(s)) * block_lanes<T> +
                                                           static_cast<std::size_t>(i));
        },
        lattice.blocks);
    return places;
}

/// Law of a particle whose onset is tested here; null otherwise.
const material::Decohesion* nonlocal_law(const LawTable& laws, std::uint8_t material)
{
    const auto& law = laws.materials[material].decohesion;
    return law && law->nonlocal_radius > 0 ? &*law : nullptr;
}

/// Append the materials of a cell of which an intact particle is near a strength.
void append_near(const View& view, const particles::Particles& particles, std::size_t slot,
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
std::vector<Candidate> near_onset(const View& view, const particles::Particles& particles)
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

std::uint64_t key_of(const Candidate& candidate)
{
    return candidate.slot * 256 + candidate.material;
}

Ball ball_of(const View& view, const particles::Particles& particles, const Candidate& candidate)
{
    return ball_about(view.options, view.levels, particles, occupied_cell(view.levels, candidate.slot),
                      candidate.material, nonlocal_law(view.laws, candidate.material)->nonlocal_radius);
}

/// Balls that are not in the table yet.
void complete_table(const View& view, const particles::Particles& particles, const std::vector<Candidate>& candidates,
                    NonlocalTable& table)
{
    std::vector<Candidate> missing;
    for (const Candidate& candidate : candidates)
        if (!table.ball.contains(key_of(candidate))) missing.push_back(candidate);
    std::vector<Ball> balls(missing.size());
    core::parallel_for(missing.size(), [&](std::size_t n) { balls[n] = ball_of(view, particles, missing[n]); });
    for (std::size_t n = 0; n < missing.size(); ++n) table.ball.emplace(key_of(missing[n]), std::move(balls[n]));
}

/// Velocity gradient [1/ms] and deformation gradient (total formulation, else unity) in the middle of a cell.
struct Motion
{
    core::Mat<Real> velocity_gradient, deformation;
};

Motion motion_of(const View& view, const particles::Particles& particles, std::size_t slot)
{
    const std::size_t leaf = slot / grid::leaf_cells;
    const CellFrame frame = cell_frame(leaf_frame(view.levels, leaf), static_cast<int>(slot % grid::leaf_cells));
    CellField field;
    read_cell(view.levels.motions(leaf) + frame.node, field);
    const LocalPosition<Real> middle{0.5, 0.5, 0.5};
    const auto gradient = [&](int column) {
        core::Mat<Real> g{};
        for (int a = 0; a < 3; ++a) {
            value_and_slopes(field, column + a, middle, g(a, 0), g(a, 1), g(a, 2));
            for (int b = 0; b < 3; ++b) g(a, b) *= frame.per_spacing;
        }
        return g;
    };
    Motion motion{gradient(velocity_column), core::identity<Real>()};
    if (view.options.formulation == Formulation::updated) return motion;
    if (view.lattice.in_use()) {
        const core::Mat<Real> displacement = gradient(change_column);
        for (std::size_t n = 0; n < 9; ++n) motion.deformation.m[n] += displacement.m[n];
    } else {
        const std::uint32_t begin = view.levels.cell_start[slot], end = view.levels.cell_start[slot + 1];
        motion.deformation = {};
        for (std::uint32_t p = begin; p < end; ++p)
            for (std::size_t n = 0; n < 9; ++n)
                motion.deformation.m[n] += particles.deformation_gradient[n][p] / (end - begin);
    }
    Real jacobian = 0;
    motion.velocity_gradient = middle_gradient(motion.velocity_gradient, motion.deformation, jacobian);
    return motion;
}

/// Normal at rest, N ~ F^T n.
Vec3 at_rest(const core::Mat<Real>& deformation, const std::array<Real, 3>& normal)
{
    Vec3 rest = Vec3::Zero();
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) rest[a] += deformation(b, a) * normal[static_cast<std::size_t>(b)];
    return rest.normalized();
}

/// Cell with a crack: the crack of its first separating particle.
struct Neighbour
{
    Vec3 offset; // mm, to the candidate's cell
    std::size_t slot;
    const core::Crack* crack;
};

std::vector<Neighbour> cracks_near(const View& view, const particles::Particles& particles, std::size_t slot,
                                   Real reach)
{
    const OccupiedCell own = occupied_cell(view.levels, slot);
    const Vec3 centre = centre_of(view.levels, own);
    std::vector<Neighbour> neighbours;
    for (const OccupiedCell& cell : cells_near(view.levels, centre, reach, 0))
        for (std::uint32_t p = view.levels.cell_start[cell.slot]; p < view.levels.cell_start[cell.slot + 1]; ++p) {
            if (particles.crack[p] < 0) continue;
            neighbours.push_back({centre - centre_of(view.levels, cell), cell.slot,
                                  &particles.cracks[static_cast<std::size_t>(particles.crack[p])]});
            break;
        }
    return neighbours;
}

/// Some crack of the cell takes up what strains the metal there: it is not through, and loaded to at least
/// `idle_loading` of what is left of its strength.
bool softens(const View& view, const particles::Particles& particles, std::size_t slot)
{
    for (std::uint32_t p = view.levels.cell_start[slot]; p < view.levels.cell_start[slot + 1]; ++p) {
        if (particles.crack[p] < 0) continue;
        const core::Crack& crack = particles.cracks[static_cast<std::size_t>(particles.crack[p])];
        if (crack.damage >= 1) continue;
        const Real q = view.laws.materials[particles.material[p]].decohesion->q;
        const material::PlaneTraction traction =
            material::plane_traction(stress_of(view, particles, p), {crack.normal});
        if (material::loading(crack, traction) >= idle_loading * material::strength_left(q, crack.damage)) return true;
    }
    return false;
}

Real excess_of(const material::Decohesion& law, const core::Sym<Real>& stress)
{
    return material::may_start(law, stress) ? material::onset_ratio(law, material::principal(stress)) : 0;
}

/// Mean stress of the intact particles of a ball.
core::Sym<Real> mean_of(const View& view, const particles::Particles& particles, const Ball& ball)
{
    return mean_stress(
        ball, [&](std::uint32_t p) { return stress_of(view, particles, p); },
        [&](std::uint32_t p) { return particles.crack[p] < 0; });
}

core::Sym<Real> ball_mean(const View& view, const particles::Particles& particles, const Candidate& candidate)
{
    const auto found = view.table.ball.find(key_of(candidate));
    if (found != view.table.ball.end()) return mean_of(view, particles, found->second);
    return mean_of(view, particles, ball_of(view, particles, candidate));
}

/// Unit vectors at rest along which cracks of neighbouring cells lead here: in their planes, which are less than 45
/// degrees off the way to this cell.
std::vector<Vec3> arriving_cracks(const View& view, const particles::Particles& particles, std::size_t slot)
{
    const Real spacing = view.levels.spacing(view.levels.leaves[slot / grid::leaf_cells].level);
    const Real beside = Real(1.6) * spacing; // a coarser neighbour's centre is at 1.5
    const core::Mat<Real> deformation = motion_of(view, particles, slot).deformation;
    std::vector<Vec3> ways;
    for (const Neighbour& other : cracks_near(view, particles, slot, beside)) {
        if (other.offset.cwiseAbs().maxCoeff() > beside) continue;
        const Vec3 normal = at_rest(deformation, other.crack->normal);
        const Real across = other.offset.dot(normal);
        if (2 * across * across <= (1 + rounding) * other.offset.squaredNorm())
            ways.push_back((other.offset - across * normal).normalized());
    }
    return ways;
}

/// Stress to test: the mean of the ball. An overloaded cell is tested on its own mean; where a crack arrives, on that
/// of the metal that the crack would cut next, if both this and its own mean exceed the criterion further than the
/// ball's.
void choose_tested(const View& view, const particles::Particles& particles, Candidate& candidate)
{
    const material::Decohesion& law = *nonlocal_law(view.laws, candidate.material);
    candidate.tested = ball_mean(view, particles, candidate);
    candidate.excess = excess_of(law, candidate.tested);
    const core::Sym<Real> own =
        mean_of(view, particles, ball_of_cell(view.levels, particles, candidate.slot, candidate.material));
    const Real own_excess = excess_of(law, own);
    candidate.overloaded = own_excess > overload;
    if (own_excess <= std::max(Real(1), candidate.excess)) return;
    if (candidate.overloaded) {
        candidate.tested = own;
        candidate.excess = own_excess;
        return;
    }
    const OccupiedCell cell = occupied_cell(view.levels, candidate.slot);
    for (const Vec3& way : arriving_cracks(view, particles, candidate.slot)) {
        const core::Sym<Real> ahead = mean_of(
            view, particles,
            ball_ahead(view.options, view.levels, particles, cell, candidate.material, way, law.nonlocal_radius));
        const Real excess = excess_of(law, ahead);
        if (excess <= candidate.excess) continue;
        candidate.tested = ahead;
        candidate.excess = excess;
    }
}

/// Cracks of the cell's intact particles, empty if a neighbour forbids them.
std::vector<Onset> cracks_of(const View& view, const particles::Particles& particles, const Candidate& candidate)
{
    const material::Material& material = view.laws.materials[candidate.material];
    const material::Decohesion& law = *material.decohesion;
    const Motion motion = motion_of(view, particles, candidate.slot);
    const std::vector<Neighbour> neighbours =
        cracks_near(view, particles, candidate.slot, std::max(law.nonlocal_radius, law.crack_exclusion));
    material::Bias bias{motion.velocity_gradient, {}};
    const auto nearest =
        std::min_element(neighbours.begin(), neighbours.end(), [](const Neighbour& a, const Neighbour& b) {
            return a.offset.squaredNorm() < b.offset.squaredNorm();
        });
    if (nearest != neighbours.end()) bias.preferred_normal = {nearest->crack->normal};

    const Real spacing = view.levels.spacing(view.levels.leaves[candidate.slot / grid::leaf_cells].level);
    std::vector<Onset> onset;
    for (std::uint32_t p = view.levels.cell_start[candidate.slot]; p < view.levels.cell_start[candidate.slot + 1]; ++p)
    {
        if (particles.crack[p] >= 0 || particles.material[p] != candidate.material) continue;
        auto crack = material::onset(law, material.elastic, candidate.tested, stress_of(view, particles, p), bias,
                                     spacing, view.options.time);
        if (!crack) continue;
        crack->particle_id = particles.id[p];
        onset.push_back({p, *crack});
    }
    if (onset.empty() || candidate.overloaded) return onset;
    const core::Crack& fresh = onset.front().crack; // all have one plane: the tested stress and the bias are the cell's
    const Vec3 normal = at_rest(motion.deformation, fresh.normal);
    for (const Neighbour& other : neighbours)
        if (excluded(other.offset, at_rest(motion.deformation, other.crack->normal), normal,
                     std::max(fresh.effective_length, other.crack->effective_length), law.crack_exclusion) &&
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

bool excluded(const Vec3& offset, const Vec3& normal, const Vec3& fresh, Real band, Real reach)
{
    const Real across = std::abs(offset.dot(normal));
    const Real along = (offset - offset.dot(normal) * normal).norm();
    return across > (1 + rounding) * band / 2 && across < (1 - rounding) * reach && along < (1 - rounding) * band &&
           std::abs(normal.dot(fresh)) > std::sqrt(Real(0.5));
}

std::size_t start_nonlocal_cracks(const PassOptions& options, const LawTable& laws, const grid::Levels& levels,
                                  Lattice& lattice, particles::Particles& particles, NonlocalTable& table)
{
    if (lattice.in_use() && table.place.empty()) table.place = lattice_places(lattice, particles.size());
    const View view{options, laws, levels, lattice, table};
    std::vector<Candidate> candidates = near_onset(view, particles);
    if (candidates.empty()) return 0;
    if (options.formulation == Formulation::total) complete_table(view, particles, candidates, table);
    core::parallel_for(candidates.size(), [&](std::size_t n) { choose_tested(view, particles, candidates[n]); });

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
