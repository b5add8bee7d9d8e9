#include "transfer/slide_batch.h"

#include "core/simd.h"
#include "material/crack_faces.h"
#include "material/rotation.h"
#include "transfer/cell_squeeze.h"
#include "transfer/solid_share.h"

namespace transfer
{
namespace
{
using V = core::Pack<Real, SlideBatch::size>;
using Mask = core::Mask<Real, SlideBatch::size>;
using Row = SlideBatch::Row;

V load(const Row& row)
{
    return V::load(row.data());
}

template <std::size_t N>
core::Mat<V> load_matrix(const std::array<Row, N>& rows)
{
    core::Mat<V> m;
    for (std::size_t n = 0; n < N; ++n) m.m[n] = load(rows[n]);
    return m;
}

/// What the cracks of the batch contribute, as rows; lanes behind the last particle repeat it.
struct CrackRows
{
    alignas(64) std::array<Row, 3> normal, slip;
    alignas(64) Row opening, length, crossed;
};

CrackRows read_cracks(const SlideBatch& batch)
{
    CrackRows rows;
    for (std::size_t i = 0; i < SlideBatch::size; ++i) {
        const core::Crack& crack = *batch.crack[std::min(i, static_cast<std::size_t>(batch.count) - 1)];
        for (std::size_t a = 0; a < 3; ++a) {
            rows.normal[a][i] = crack.normal[a];
            rows.slip[a][i] = crack.slip[a];
        }
        rows.opening[i] = crack.opening;
        rows.length[i] = crack.effective_length;
        rows.crossed[i] = crack.second_time >= 0 ? 1 : 0;
    }
    return rows;
}

/// Lanes that still mean something: see separate_particle.
/// @param share  1, solid share
Mask sound(const PassOptions& options, const LawTable& laws, Real per_spacing, const V& share, const SlideBatch& batch)
{
    const V reach(laws.constants[batch.material].wave_speed * options.dt * per_spacing);
    const V ratio = load(batch.volume_ratio);
    return (ratio > V(smallest_volume_ratio)) &
           (step_share(reach, ratio * share, load_matrix(batch.deformation)) <= load(batch.largest_share));
}

void write_cracks(const material::Faces<V>& faces, Mask moved, Real time, SlideBatch& batch)
{
    for (int i = 0; i < batch.count; ++i) {
        if (!moved[i]) continue;
        core::Crack& crack = *batch.crack[static_cast<std::size_t>(i)];
        for (int a = 0; a < 3; ++a) {
            crack.normal[static_cast<std::size_t>(a)] = faces.normal[a][i];
            crack.slip[static_cast<std::size_t>(a)] = faces.slip[a][i];
        }
        crack.opening = faces.opening[i];
        if (crack.second_time < 0 && faces.crossed[i] > 0) crack.second_time = time;
    }
}
} // namespace

void slide_batch(const PassOptions& options, const LawTable& laws, Real per_spacing, SlideBatch& batch)
{
    const CrackRows rows = read_cracks(batch);
    const core::Mat<V> gradient = load_matrix(batch.gradient);
    const V opening_before = load(rows.opening), length = load(rows.length), zero(Real(0));
    material::Faces<V> faces{{{load(rows.normal[0]), load(rows.normal[1]), load(rows.normal[2])}},
                             {{load(rows.slip[0]), load(rows.slip[1]), load(rows.slip[2])}},
                             opening_before,
                             length,
                             {},
                             load(batch.eq_plastic_strain),
                             zero,
                             zero,
                             load(rows.crossed)};
    for (std::size_t n = 0; n < 6; ++n) faces.stress.s[n] = load(batch.stress[n]);
    const material::SeparationLaw& law = laws.separation[batch.material];
    const auto before =
        material::begin_step(law, material::spin_increment(gradient), core::symmetric_part(gradient), faces);
    material::slide(law, before, faces);

    const V share = solid_share(length, opening_before);
    const Mask moved = sound(options, laws, per_spacing, share, batch);
    const V volume = load(batch.volume) * share;
    for (std::size_t n = 0; n < 6; ++n) core::select(moved, faces.stress.s[n], zero).store(batch.stress[n].data());
    core::select(moved, faces.eq_plastic_strain, load(batch.eq_plastic_strain)).store(batch.eq_plastic_strain.data());
    core::select(moved, faces.plastic_work * volume, zero).store(batch.plastic_work.data());
    core::select(moved, faces.decohesion_work * volume, zero).store(batch.decohesion_work.data());
    write_cracks(faces, moved, options.time, batch);
}
} // namespace transfer
