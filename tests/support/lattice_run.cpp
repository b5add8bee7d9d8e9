#include "tests/support/lattice_run.h"

#include "grid/halo.h"
#include "grid/interface.h"
#include "grid/nodal.h"
#include "particles/order.h"
#include "particles/tensors.h"

#include <bit>
#include <stdexcept>

namespace support
{
namespace
{
/// Drop the particles for which `wanted` does not hold.
template <class Wanted>
void keep(const Wanted& wanted, particles::Particles& particles)
{
    std::vector<std::uint32_t> kept;
    for (std::uint32_t p = 0; p < particles.size(); ++p)
        if (wanted(p)) kept.push_back(p);
    particles::reorder(kept, particles);
}

void add_work(LatticeRun& run)
{
    for (const transfer::LeafWork& work : run.scene.leaf_work) {
        run.plastic_work += work.plastic;
        run.decohesion_work += work.decohesion;
    }
}
} // namespace

Scene cut_scene(const Topology& topology, const std::vector<material::Material>& materials, std::uint64_t seed)
{
    transfer::PassOptions options;
    options.transfer = transfer::Transfer::nodal;
    Scene scene = scene_of(topology, options, materials, Layout::regular, seed);
    Random random(seed);
    bool cell_is_empty = false;
    keep(
        [&](std::uint32_t p) {
            if (p % 8 == 0) cell_is_empty = random.whole(0, 9) == 0; // all cells are full so far
            return random.whole(0, 4) != 0 && !cell_is_empty;
        },
        scene.particles);
    particles::Particles& particles = scene.particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        if (particles.rest_position[0][p] > scene.levels.origin[0])
            particles.material[p] = static_cast<std::uint8_t>(random.whole(0, static_cast<int>(materials.size()) - 1));
        particles.rest_volume[p] *= random.between(0.3, 1);
        particles.mass[p] = particles.rest_volume[p] * materials[particles.material[p]].elastic.density;
    }
    order(scene);
    return scene;
}

void stir(std::uint64_t seed, Real stress, Real velocity, Scene& scene)
{
    randomise_state(seed, scene);
    for (particles::Column& column : scene.particles.stress)
        for (Real& entry : column) entry *= stress;
    for (particles::Column& column : scene.particles.velocity)
        for (Real& entry : column) entry *= velocity;
    transfer::scatter(scene.options, scene.laws, scene.strays, scene.particles, scene.levels);
}

LatticeRun lattice_run(Scene scene, transfer::Precision precision, const std::vector<grid::WallPlane>& walls,
                       const Vec3& gravity)
{
    LatticeRun run{std::move(scene), {}, walls, gravity, 0, 0, {}};
    grid::Levels& levels = run.scene.levels;
    grid::start_nodes(walls, std::vector<Real>(static_cast<std::size_t>(levels.count), Real(0)), levels);
    grid::prolong_motion(levels);
    grid::fill_motion_halos(levels);
    if (!transfer::enter_lattice(precision, levels, run.scene.particles, run.lattice))
        throw std::logic_error("the scene's particles are not on the lattice");
    run.fast_nodes = grid::find_fast_nodes(levels, {});
    return run;
}

void advance(Real dt, LatticeRun& run)
{
    Scene& scene = run.scene;
    scene.options.dt = dt;
    scene.options.time += dt;
    grid::advance_nodes(run.walls, run.gravity, {dt}, scene.levels);
    grid::prolong_motion(scene.levels);
    grid::fill_motion_halos(scene.levels);
    scene.leaf_work.assign(scene.levels.leaves.size(), {});
    transfer::advance_lattice(scene.options, scene.laws, run.lattice, scene.particles, scene.levels, scene.leaf_work);
    add_work(run);
}

void advance_subcycled(Real dt, LatticeRun& run)
{
    Scene& scene = run.scene;
    const int finest = scene.levels.count - 1;
    grid::LevelSteps steps{dt, 0, finest, true};
    scene.leaf_work.assign(scene.levels.leaves.size(), {});
    for (unsigned n = 0; n < 1U << finest; ++n) {
        scene.options.time += dt;
        steps.first = n == 0 ? 0 : finest - std::countr_zero(n);
        grid::advance_nodes(run.walls, run.gravity, steps, scene.levels);
        grid::drift_fast_nodes(dt, scene.levels, run.fast_nodes);
        steps.first = finest - std::countr_zero(n + 1);
        grid::prolong_displacement(steps, scene.levels);
        grid::average_fast_nodes(steps, scene.levels, run.fast_nodes);
        grid::fill_motion_halos(scene.levels, steps.first);
        transfer::advance_lattice(steps, scene.options, scene.laws, run.lattice, scene.particles, scene.levels,
                                  scene.leaf_work);
        grid::release_fast_nodes(steps, scene.levels, run.fast_nodes);
    }
    add_work(run);
}

DenseNodal dense_nodal(const Scene& scene, const std::vector<grid::WallPlane>& walls, const Vec3& gravity)
{
    DenseNodal dense;
    dense.spacing0 = scene.levels.spacing0;
    dense.levels = scene.levels.count;
    dense.origin = scene.levels.origin;
    dense.gravity = gravity;
    dense.walls = walls;
    dense.laws = scene.laws;
    const particles::Particles& particles = scene.particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        NodalPoint& point = dense.points.emplace_back();
        point.rest_position = vector_of(particles.rest_position, p);
        point.velocity = vector_of(particles.velocity, p);
        point.level = particles.size_level[p];
        point.rest_volume = particles.rest_volume[p];
        point.mass = particles.mass[p];
        point.material = particles.material[p];
        point.stress = particles::stress_of(particles, p);
    }
    dense.start();
    return dense;
}

particles::Particles filled(const LatticeRun& run)
{
    particles::Particles particles = run.scene.particles;
    transfer::fill_columns(run.scene.levels, run.lattice, particles);
    return particles;
}
} // namespace support
