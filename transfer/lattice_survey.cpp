#include "core/parallel.h"
#include "material/elastic.h"
#include "transfer/block_work.h"
#include "transfer/cell_squeeze.h"
#include "transfer/lattice_squeeze.h"
#include "transfer/leaf_columns.h"
#include "transfer/solid_share.h"

#include <bit>
#include <cmath>

namespace transfer
{
namespace
{
/// Metal part of the volumes; separated particles transmit nothing and do not count.
template <class T>
[[gnu::noinline]] void regard_cracks(const Context& context, const BlockPart<T>& part,
                                     const particles::Particles& particles, int slot, PartLanes<T>& volume,
                                     PartLanes<T>& counts)
{
    for (int i = 0; i < part.count(); ++i) {
        const auto cell = static_cast<std::size_t>(part.cell(i));
        if (context.lattice.cracked[context.leaf * grid::leaf_cells + cell] == 0 || !part.has(i, slot)) continue;
        const std::int32_t index = particles.crack[part.particle(i, slot)];
        if (index < 0) continue;
        const core::Crack& crack = particles.cracks[static_cast<std::size_t>(index)];
        volume.v[i] *= static_cast<T>(solid_share(crack));
        if (crack.damage >= 1) counts.v[i] = 0;
    }
}

/// Masses for volumes, in a leaf of several materials.
template <class T>
[[gnu::noinline]] void regard_densities(const Context& context, const BlockPart<T>& part,
                                        const particles::Particles& particles, int slot, PartLanes<T>& counts)
{
    for (int i = 0; i < part.count(); ++i)
        if (part.has(i, slot)) {
            const std::uint8_t material = particles.material[part.particle(i, slot)];
            counts.v[i] *= static_cast<T>(context.laws.materials[material].elastic.density);
        }
}

/// Energy of the particles of one slot [mJ].
template <class T>
Real energy_of(const SlotLaw<T>& law, const BlockPart<T>& part, const BlockState<T>& state, int slot,
               const PartLanes<T>& volume)
{
    using V = PartLanes<T>;
    core::Sym<V> stress;
    for (std::size_t n = 0; n < 6; ++n) stress.s[n] = part.load(state.stress[n], slot);
    return static_cast<Real>(core::sum(
        core::select(volume > V(T(0)), volume * material::stored_energy(law.lame, law.shear, stress), V(T(0)))));
}

/// Weight of a slot on a corner that differs from it along `axes` of the three.
constexpr Real corner_weight(int axes)
{
    constexpr Real weights[] = {27.0 / 64, 9.0 / 64, 3.0 / 64, 1.0 / 64};
    return weights[axes];
}

/// Largest mean over a corner of a cell of what its slots have, weighted by their share of the corner's mass.
/// @param counts  masses, or volumes of one density; zero: left out
template <class V>
V largest_corner_mean(const V (&value)[slots], const V (&counts)[slots])
{
    const V zero(Real(0));
    V largest = zero;
    for (unsigned corner = 0; corner < slots; ++corner) {
        V sum = zero, weight = zero;
        for (unsigned s = 0; s < slots; ++s) {
            const V w = V(corner_weight(std::popcount(corner ^ s))) * counts[s];
            sum += core::select(counts[s] > zero, w * value[s], zero);
            weight += w;
        }
        const V mean = core::select(weight > zero, sum / weight, zero);
        // What is not a number is kept.
        largest = core::select(mean <= largest, largest, mean);
    }
    return largest;
}

/// Slot of a lane that has become stiffest for its mass among those that count; the first that is not a number.
template <class V>
int tightest_slot(const V (&squared)[slots], const V (&counts)[slots], int lane)
{
    int tightest = -1;
    for (int s = 0; s < slots; ++s) {
        if (!(counts[s][lane] > 0)) continue;
        if (tightest < 0 || !(squared[s][lane] <= squared[tightest][lane])) tightest = s;
        if (std::isnan(squared[s][lane])) break;
    }
    return tightest;
}

template <bool with_energy, class T>
void survey_part(const Context& context, const particles::Particles& particles, const MotionColumns<T>& motion,
                 const BlockPart<T>& part, const BlockState<T>& state, LatticeSurvey& survey)
{
    using V = PartLanes<T>;
    V velocity[3][8], corner[3][8];
    gather_corners(motion, part, velocity, corner);
    Slopes<V> displacement[3];
    for (int a = 0; a < 3; ++a) displacement[a] = slopes_at_slots(corner[a]);
    SlotLaw<T> law[slots];
    const int law_step = with_energy ? find_laws(context, part, particles, law) : 0;
    V squared[slots], counts[slots];
    for (int s = 0; s < slots; ++s) {
        const core::Mat<V> f = deformation_at(displacement, s, context.per_spacing);
        V volume = counts[s] = part.load(state.rest_volume, s);
        if (!particles.cracks.empty()) regard_cracks(context, part, particles, s, volume, counts[s]);
        if (context.lattice.material[context.leaf] == Lattice::mixed)
            regard_densities(context, part, particles, s, counts[s]);
        squared[s] = cell_stiffening(f);
        if constexpr (with_energy)
            survey.elastic += energy_of(law[s * law_step], part, state, s, volume * core::determinant(f));
    }
    const V squeeze = core::sqrt(largest_corner_mean(squared, counts));
    for (int i = 0; i < part.count(); ++i) {
        // Not std::max, which drops a NaN.
        if (std::isnan(survey.squeeze) || squeeze[i] <= static_cast<T>(survey.squeeze)) continue;
        survey.squeeze = static_cast<Real>(squeeze[i]);
        survey.worst = part.particle(i, tightest_slot(squared, counts, i));
    }
}

template <bool with_energy, class T>
void survey_block(const Context& context, const particles::Particles& particles, const MotionColumns<T>& motion,
                  const CellBlock<T>& block, const BlockState<T>& state, LatticeSurvey& survey)
{
    for (int first = 0; first < block.count; first += part_lanes<T>)
        survey_part<with_energy>(context, particles, motion, BlockPart<T>{block, first}, state, survey);
}

template <bool with_energy, class T>
void survey_leaf(const Context& context, const particles::Particles& particles, const grid::Levels& levels,
                 const BlockTable<T>& table, LatticeSurvey& survey)
{
    const std::uint32_t begin = table.start[context.leaf], end = table.start[context.leaf + 1];
    if (begin == end) return;
    MotionColumns<T> motion;
    read_motion(levels.motions(context.leaf), levels.used[context.leaf], table.block[begin].node[0], motion);
    for (std::uint32_t b = begin; b < end; ++b)
        survey_block<with_energy>(context, particles, motion, table.block[b], table.state[b], survey);
}

template <bool with_energy>
void survey_leaves(const LawTable& laws, const Lattice& lattice, const particles::Particles& particles,
                   const grid::Levels& levels, std::vector<LatticeSurvey>& survey)
{
    survey.assign(levels.leaves.size(), {});
    const PassOptions no_step;
    std::visit(
        [&](const auto& table) {
            core::parallel_for(survey.size(), [&](std::size_t n) {
                const Context context{no_step, laws, lattice, Real(1) / levels.spacing(levels.leaves[n].level), n};
                survey_leaf<with_energy>(context, particles, levels, table, survey[n]);
            });
        },
        lattice.blocks);
}
} // namespace

void survey_lattice(const LawTable& laws, const Lattice& lattice, const particles::Particles& particles,
                    const grid::Levels& levels, std::vector<LatticeSurvey>& survey)
{
    survey_leaves<true>(laws, lattice, particles, levels, survey);
}

void survey_squeeze(const LawTable& laws, const Lattice& lattice, const particles::Particles& particles,
                    const grid::Levels& levels, std::vector<LatticeSurvey>& survey)
{
    survey_leaves<false>(laws, lattice, particles, levels, survey);
}
} // namespace transfer
