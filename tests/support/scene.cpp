#include "tests/support/scene.h"

#include "grid/halo.h"
#include "grid/interface.h"
#include "grid/momentum.h"
#include "grid/topology.h"
#include "particles/order.h"
#include "transfer/gimp_cover.h"

#include <algorithm>
#include <numeric>

namespace support
{
namespace
{
void add_particle(const Vec3& at, Real volume, const grid::CellKey& key, int material, Scene& scene)
{
    particles::Particles& p = scene.particles;
    for (std::size_t a = 0; a < 3; ++a) {
        p.position[a].push_back(at[static_cast<int>(a)]);
        p.rest_position[a].push_back(at[static_cast<int>(a)]);
        p.velocity[a].push_back(0);
    }
    for (particles::Column& component : p.stress) component.push_back(0);
    p.rest_volume.push_back(volume);
    p.mass.push_back(volume * scene.laws.materials[static_cast<std::size_t>(material)].elastic.density);
    p.eq_plastic_strain.push_back(0);
    p.crack.push_back(-1);
    p.id.push_back(static_cast<std::uint32_t>(p.id.size()));
    p.target_level.push_back(static_cast<std::uint8_t>(key.level));
    p.size_level.push_back(static_cast<std::uint8_t>(key.level));
    p.material.push_back(static_cast<std::uint8_t>(material));
    p.away.push_back(0);
}

void fill_cell(const grid::CellKey& key, Layout layout, Random& random, Scene& scene)
{
    const Real h = scene.levels.spacing(key.level);
    const Vec3 lower = scene.levels.origin + h * key.cell.cast<Real>();
    if (layout == Layout::regular) {
        for (int c = 0; c < 8; ++c)
            add_particle(lower + h * (Vec3::Constant(0.25) + 0.5 * Vec3(c >> 2, c >> 1 & 1, c & 1)), h * h * h / 8, key,
                         0, scene);
        return;
    }
    const int count = random.whole(1, 20);
    const int materials = static_cast<int>(scene.laws.materials.size());
    for (int n = 0; n < count; ++n)
        add_particle(lower + h * random.vector(0, 1), h * h * h * random.between(0.5, 1.5) / count, key,
                     random.whole(0, materials - 1), scene);
}

void add_scheme_columns(Scene& scene)
{
    const std::size_t count = scene.particles.size();
    if (scene.options.formulation == transfer::Formulation::total) {
        for (std::size_t n = 0; n < 9; ++n) scene.particles.deformation_gradient[n].assign(count, n % 4 == 0 ? 1 : 0);
    } else {
        scene.particles.volume_ratio.assign(count, 1);
    }
    if (scene.options.transfer == transfer::Transfer::apic)
        for (particles::Column& entry : scene.particles.affine) entry.assign(count, 0);
}
} // namespace

material::Material soft_elastic()
{
    material::Material m;
    m.elastic = {1e-3, 1000, 0.3};
    return m;
}

std::vector<material::Material> two_metals(Real yield_stress, bool averaged)
{
    material::Material soft = soft_elastic();
    soft.plastic = material::VonMises{yield_stress, 50};
    soft.cell_averaged_dilatation = averaged;
    material::Material hard = soft;
    hard.elastic = {3e-3, 2500, 0.2};
    hard.plastic.reset();
    return {soft, hard};
}

Scene scene_of(const Topology& topology, const transfer::PassOptions& options,
               const std::vector<material::Material>& materials, Layout layout, std::uint64_t seed)
{
    Scene scene{options, transfer::law_table(materials), topology.refinement, levels_of(topology), {}, {}, {}, 0};
    Random random(seed);
    for (const grid::CellKey& key : topology.cells) fill_cell(key, layout, random, scene);
    add_scheme_columns(scene);
    order(scene);
    return scene;
}

void randomise_state(std::uint64_t seed, Scene& scene)
{
    Random random(seed);
    particles::Particles& p = scene.particles;
    const auto fill = [&](particles::Column& column, Real size) {
        for (Real& entry : column) entry = random.between(-size, size);
    };
    for (particles::Column& column : p.velocity) fill(column, 1);
    for (particles::Column& column : p.stress) fill(column, 1);
    for (particles::Column& column : p.affine) fill(column, 1);
}

void disturb(std::uint64_t seed, Scene& scene)
{
    Random random(seed);
    particles::Particles& p = scene.particles;
    const auto cell_of = [&](std::size_t n) {
        return scene.refinement.locate((vector_of(p.position, n) - scene.levels.origin) * (1 / scene.levels.spacing0));
    };
    for (std::size_t n = 0; n < p.size(); ++n) {
        const grid::CellKey home = cell_of(n);
        const Vec3 from = vector_of(p.position, n);
        const Vec3 to = from + scene.levels.spacing(home.level) * random.vector(-0.33, 0.33);
        for (std::size_t a = 0; a < 3; ++a) p.position[a][n] = to[static_cast<int>(a)];
        const grid::CellKey cell = cell_of(n);
        if (grid::active_slot(scene.levels, cell.level, cell.cell) < 0) {
            for (std::size_t a = 0; a < 3; ++a) p.position[a][n] = from[static_cast<int>(a)];
            continue;
        }
        p.away[n] = cell.level != home.level || cell.cell != home.cell ? 1 : 0;
    }
    transfer::cover_boxes(scene.options, scene.refinement, p, scene.levels);
    scene.leaf_work.assign(scene.levels.leaves.size(), {});
    transfer::assign_all(scene.options, p, scene.levels, scene.strays);
    if (transfer::uses_boxes(scene.options)) // new cells, new visitors
        transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels);
}

void order(Scene& scene)
{
    const particles::Particles& p = scene.particles;
    const auto& at = scene.options.formulation == transfer::Formulation::total ? p.rest_position : p.position;
    std::vector<grid::CellKey> key;
    for (std::size_t n = 0; n < p.size(); ++n)
        key.push_back(scene.refinement.locate((vector_of(at, n) - scene.levels.origin) * (1 / scene.levels.spacing0)));
    grid::build(key, scene.levels);

    std::vector<std::size_t> slot;
    scene.levels.cell_start.assign(scene.levels.leaves.size() * grid::leaf_cells + 1, 0);
    for (const grid::CellKey& k : key) {
        slot.push_back(static_cast<std::size_t>(grid::slot_of(scene.levels, k)));
        ++scene.levels.cell_start[slot.back() + 1];
    }
    std::partial_sum(scene.levels.cell_start.begin(), scene.levels.cell_start.end(), scene.levels.cell_start.begin());
    std::vector<std::uint32_t> ordered(p.size());
    std::iota(ordered.begin(), ordered.end(), 0U);
    std::sort(ordered.begin(), ordered.end(), [&](std::uint32_t a, std::uint32_t b) {
        return slot[a] != slot[b] ? slot[a] < slot[b] : p.id[a] < p.id[b];
    });
    particles::reorder(ordered, scene.particles);
    std::fill(scene.particles.away.begin(), scene.particles.away.end(), std::uint8_t(0));
    transfer::cover_boxes(scene.options, scene.refinement, scene.particles, scene.levels);
    scene.strays.refinement = scene.refinement;
    transfer::assign_all(scene.options, scene.particles, scene.levels, scene.strays);
    scene.leaf_work.assign(scene.levels.leaves.size(), {});
    transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels);
}

void gather_sums(Scene& scene)
{
    transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels);
    grid::assemble_sums(scene.levels);
    grid::restrict_sums(scene.levels);
}

void prescribe_motion(const std::function<Vec3(const Vec3&)>& velocity, grid::Levels& levels)
{
    for_each_free_node(levels, [&](const grid::NodeAddress& at, const Vec3& x) {
        grid::NodeMotion& motion = levels.motions(static_cast<std::size_t>(at.leaf))[at.node];
        const Vec3 v = velocity(x);
        for (int a = 0; a < 3; ++a)
            motion.velocity[static_cast<std::size_t>(a)] = motion.change[static_cast<std::size_t>(a)] = v[a];
    });
    grid::prolong_motion(levels);
    grid::fill_motion_halos(levels);
}

void advance(Real dt, Scene& scene)
{
    scene.options.dt = dt;
    scene.options.time += dt;
    const std::vector<Real> no_cutoff(static_cast<std::size_t>(scene.levels.count), Real(0));
    grid::assemble_sums(scene.levels);
    grid::restrict_sums(scene.levels);
    grid::advance_momentum({}, Vec3::Zero(), no_cutoff, dt, scene.levels);
    grid::prolong_motion(scene.levels);
    grid::fill_motion_halos(scene.levels);
    if (scene.options.stress_update == transfer::StressUpdate::musl) {
        transfer::remap_momentum(scene.options, scene.strays, scene.particles, scene.levels);
        grid::assemble_momentum(scene.levels);
        grid::restrict_momentum(scene.levels);
        grid::remap_velocity({}, no_cutoff, scene.levels);
        grid::prolong_motion(scene.levels);
        grid::fill_motion_halos(scene.levels);
    }
    scene.leaf_work.assign(scene.levels.leaves.size(), {});
    transfer::advance_and_scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels,
                                  scene.leaf_work);
    for (const transfer::LeafWork& work : scene.leaf_work) scene.plastic_work += work.plastic;
    if (transfer::worth_reordering(scene.options, scene.strays, scene.particles)) order(scene);
}

Vec3 vector_of(const std::array<particles::Column, 3>& columns, std::size_t p)
{
    return {columns[0][p], columns[1][p], columns[2][p]};
}

Eigen::Matrix3d matrix_of(const std::array<particles::Column, 9>& columns, std::size_t p)
{
    Eigen::Matrix3d m;
    for (int n = 0; n < 9; ++n) m(n / 3, n % 3) = columns[static_cast<std::size_t>(n)][p];
    return m;
}

Eigen::Matrix3d stress_of(const particles::Particles& particles, std::size_t p)
{
    const auto& s = particles.stress;
    Eigen::Matrix3d m;
    m << s[0][p], s[3][p], s[5][p], s[3][p], s[1][p], s[4][p], s[5][p], s[4][p], s[2][p];
    return m;
}

Vec3 vector_of(const std::array<Real, 3>& values)
{
    return {values[0], values[1], values[2]};
}
} // namespace support
