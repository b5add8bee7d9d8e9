#include "tests/support/dense_nodal.h"

#include "material/decohesion.h"
#include "material/onset.h"
#include "material/rotation.h"
#include "transfer/separate_particle.h"
#include "transfer/solid_share.h"

#include <cmath>

namespace support
{
namespace
{
using Mat = core::Mat<Real>;
using Sym = core::Sym<Real>;
using Node = DenseNodal::Node;
using Cell = DenseNodal::Cell;

Vec3 corner_bits(int c)
{
    return {Real(c >> 2), Real(c >> 1 & 1), Real(c & 1)};
}

Cell cell_of(const DenseNodal& mpm, const NodalPoint& p)
{
    const Vec3 scaled = (p.rest_position - mpm.origin) / (mpm.spacing0 / (1 << p.level));
    return {p.level, int(std::floor(scaled[0])), int(std::floor(scaled[1])), int(std::floor(scaled[2]))};
}

/// A coarser cell that has the node on its surface: such a node hangs.
std::optional<Cell> coarse_cell(const DenseNodal& mpm, int level, const Node& at)
{
    for (int c = 0; c < 8; ++c) {
        const Cell cell{level - 1, (at[0] - (c >> 2)) >> 1, (at[1] - (c >> 1 & 1)) >> 1, (at[2] - (c & 1)) >> 1};
        if (level > 0 && mpm.cells.count(cell) > 0) return cell;
    }
    return {};
}

/// Call visit(free node, its level, weight) for what moves the node `at` of a level.
template <class Visit>
void resolve(const DenseNodal& mpm, int level, const Node& at, Real weight, const Visit& visit)
{
    const std::optional<Cell> coarse = coarse_cell(mpm, level, at);
    if (!coarse) {
        const int shift = mpm.levels - 1 - level;
        return visit(Node{at[0] << shift, at[1] << shift, at[2] << shift}, level, weight);
    }
    for (int c = 0; c < 8; ++c) {
        Real part = weight;
        Node corner;
        for (std::size_t a = 0; a < 3; ++a) {
            const int bit = int(corner_bits(c)[int(a)]), lower = (*coarse)[a + 1];
            const Real local = Real(at[a] - 2 * lower) / 2;
            part *= bit ? local : 1 - local;
            corner[a] = lower + bit;
        }
        if (part != 0) resolve(mpm, level - 1, corner, part, visit);
    }
}

std::vector<DenseNodal::Share> basis_of(const DenseNodal& mpm, const NodalPoint& p)
{
    const Real h = mpm.spacing0 / (1 << p.level);
    const Cell cell = cell_of(mpm, p);
    const Vec3 t = (p.rest_position - mpm.origin) / h - Vec3(cell[1], cell[2], cell[3]);
    std::vector<DenseNodal::Share> shares;
    for (int c = 0; c < 8; ++c) {
        const Vec3 bit = corner_bits(c);
        Vec3 w, d;
        for (int a = 0; a < 3; ++a) {
            w[a] = bit[a] > 0 ? t[a] : 1 - t[a];
            d[a] = (bit[a] > 0 ? 1 : -1) / h;
        }
        const Vec3 slope(d[0] * w[1] * w[2], w[0] * d[1] * w[2], w[0] * w[1] * d[2]);
        resolve(mpm, p.level, {cell[1] + int(bit[0]), cell[2] + int(bit[1]), cell[3] + int(bit[2])}, 1,
                [&](const Node& node, int level, Real weight) {
                    shares.push_back({node, level, weight * w.prod(), weight * slope});
                });
    }
    return shares;
}

/// V0 P without what cracks leave open: f_i = - sum V0 P grad w.
Mat flux_of(const NodalPoint& p)
{
    const Mat cof = core::cofactor(p.deformation_gradient);
    const Real volume = p.rest_volume * (p.crack ? transfer::solid_share(*p.crack) : Real(1));
    Mat flux{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) flux(i, j) += volume * p.stress(i, k) * cof(k, j);
    return flux;
}

/// Points of every level, or of one.
bool is_on(int level, const NodalPoint& p)
{
    return level == DenseNodal::all_levels || p.level == level;
}

/// v += dt f / m by the points of one level, and dt g on its nodes.
void push(DenseNodal& mpm, Real dt, int level)
{
    for (auto& [key, node] : mpm.nodes) node.force.setZero();
    for (std::size_t p = 0; p < mpm.points.size(); ++p) {
        if (!is_on(level, mpm.points[p])) continue;
        const Mat flux = flux_of(mpm.points[p]);
        for (const DenseNodal::Share& s : mpm.basis[p])
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) mpm.nodes[s.node].force[i] -= flux(i, j) * s.slope[j];
    }
    for (auto& [key, node] : mpm.nodes) {
        node.velocity += dt * node.force / node.mass;
        if (level == DenseNodal::all_levels || node.level == level) node.velocity += dt * mpm.gravity;
        for (const grid::WallPlane& wall : mpm.walls)
            if (key[std::size_t(wall.axis)] == wall.node0 << (mpm.levels - 1)) node.velocity[wall.axis] = 0;
    }
}

void drift(DenseNodal& mpm, Real dt)
{
    for (auto& [key, node] : mpm.nodes) node.displacement += dt * node.velocity;
}

/// How a point deforms in a step.
struct Strain
{
    Mat increment; // 1, L dt
    Real ratio;    // 1, J in the middle of the step
    Real volume;   // mm^3, there
};

Strain deform(const DenseNodal& mpm, std::size_t p, Mat& f)
{
    const Mat before = f;
    Mat rate{}, middle{};
    f = core::identity<Real>();
    for (const DenseNodal::Share& s : mpm.basis[p]) {
        const DenseNodal::NodeState& node = mpm.nodes.at(s.node);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) f(i, j) += node.displacement[i] * s.slope[j];
    }
    for (std::size_t n = 0; n < 9; ++n) {
        rate.m[n] = f.m[n] - before.m[n];
        middle.m[n] = f.m[n] - rate.m[n] / 2;
    }
    const Real ratio = core::determinant(middle);
    const Mat cof = core::cofactor(middle); // inverse = cof^T / det
    const Mat transposed{
        {cof(0, 0), cof(1, 0), cof(2, 0), cof(0, 1), cof(1, 1), cof(2, 1), cof(0, 2), cof(1, 2), cof(2, 2)}};
    Mat increment = rate * transposed;
    for (Real& entry : increment.m) entry /= ratio;
    return {increment, ratio, mpm.points[p].rest_volume * ratio};
}

Real trace(const Mat& m)
{
    return m(0, 0) + m(1, 1) + m(2, 2);
}

/// The plastic law; the strain has its mean dilatation already.
void yield(const transfer::LawConstants& law, const Strain& s, const Sym& strain, NodalPoint& p, DenseNodal& mpm)
{
    const auto spin = material::spin_increment(s.increment);
    const Sym trial = material::elastic_trial(core::rotated(material::incremental_rotation(spin), p.stress),
                                              material::at_end_of_step(strain, spin),
                                              material::LameConstants<Real>{law.lame, 2 * law.shear});
    const material::PlasticStep<Real> step = material::radial_return(
        trial, p.eq_plastic_strain,
        material::PlasticConstants<Real>{law.yield, law.hardening, 3 * law.shear, law.per_overstress});
    p.stress = step.stress;
    p.eq_plastic_strain = step.eq_plastic_strain;
    mpm.plastic_work += s.volume * step.work;
}

void separate(Real dt, const Strain& s, Real spacing, bool full_cell, NodalPoint& p, DenseNodal& mpm)
{
    transfer::PassOptions options;
    options.dt = dt;
    options.time = mpm.time;
    const transfer::SeparationInput input{{p.stress, core::symmetric_part(s.increment),
                                           material::spin_increment(s.increment), p.eq_plastic_strain, dt, mpm.time},
                                          s.volume,
                                          s.ratio,
                                          &p.deformation_gradient,
                                          p.material,
                                          1 / spacing,
                                          full_cell ? transfer::unstable_step_share : transfer::deformed_step_share};
    const transfer::SeparationResult result = transfer::separate_particle(options, mpm.laws, input, *p.crack);
    p.stress = result.stress;
    p.eq_plastic_strain = result.eq_plastic_strain;
    mpm.plastic_work += result.plastic_work;
    mpm.decohesion_work += result.decohesion_work;
}

/// Does the stress of some particle that may start a crack come near its strengths? Only then the cell is looked at.
bool near_onset(const DenseNodal& mpm, const std::vector<std::size_t>& cell)
{
    for (const std::size_t n : cell) {
        const NodalPoint& p = mpm.points[n];
        const transfer::LawConstants& law = mpm.laws.constants[p.material];
        if (!p.crack && material::may_start(p.stress, law.tensile_onset, law.shear_onset)) return true;
    }
    return false;
}

/// Onsets of one cell; they count from the next step on.
void start_cracks(const DenseNodal& mpm, const std::vector<std::size_t>& cell, const std::vector<Strain>& strain,
                  Real dt, Real spacing, std::vector<std::optional<core::Crack>>& fresh)
{
    core::Vec<Real> nearest{};
    for (const std::size_t n : cell)
        if (const NodalPoint& p = mpm.points[n]; p.crack) {
            nearest = {p.crack->normal};
            break;
        }
    if (!near_onset(mpm, cell)) return;
    const auto mean_of = [&](std::uint8_t material) { // of its intact points
        Sym mean{};
        Real volume = 0;
        for (const std::size_t n : cell) {
            const NodalPoint& p = mpm.points[n];
            if (p.crack || p.material != material) continue;
            mean = mean + p.rest_volume * p.stress;
            volume += p.rest_volume;
        }
        return (1 / volume) * mean;
    };
    for (const std::size_t n : cell) {
        const NodalPoint& p = mpm.points[n];
        const material::Material& m = mpm.laws.materials[p.material];
        if (p.crack || !m.decohesion) continue;
        Mat l = strain[n].increment;
        for (Real& entry : l.m) entry /= dt;
        fresh[n] =
            material::onset(*m.decohesion, m.elastic, m.decohesion->smoothed_onset ? mean_of(p.material) : p.stress,
                            p.stress, {l, nearest}, spacing, mpm.time);
    }
}

/// Strain, stress and cracks of the points of a level after its step of dt.
void update(DenseNodal& mpm, Real dt, int level)
{
    std::vector<NodalPoint>& points = mpm.points;
    std::vector<Strain> strain(points.size());
    for (std::size_t p = 0; p < points.size(); ++p)
        if (is_on(level, points[p])) strain[p] = deform(mpm, p, points[p].deformation_gradient);

    std::vector<std::optional<core::Crack>> fresh(points.size());
    for (const auto& [key, cell] : mpm.cells) {
        if (level != DenseNodal::all_levels && key[0] != level) continue;
        const Real spacing = mpm.spacing0 / (1 << key[0]);
        const auto averaged = [&](std::size_t n) {
            return mpm.laws.constants[points[n].material].averaged_dilatation &&
                   !(strain[n].volume < transfer::least_averaged_volume * points[n].rest_volume);
        };
        Real volume = 0, dilated = 0;
        for (const std::size_t n : cell) {
            if (points[n].crack || !averaged(n)) continue;
            volume += strain[n].volume;
            dilated += strain[n].volume * trace(strain[n].increment);
        }
        for (const std::size_t n : cell) {
            NodalPoint& p = points[n];
            if (p.crack) {
                separate(dt, strain[n], spacing, cell.size() == 8, p, mpm);
                continue;
            }
            const transfer::LawConstants& law = mpm.laws.constants[p.material];
            Sym e = core::symmetric_part(strain[n].increment);
            const Real shift = averaged(n) ? (dilated / volume - core::trace(e)) / 3 : Real(0);
            for (int a = 0; a < 3; ++a) e[a] += shift;
            yield(law, strain[n], e, p, mpm);
        }
        start_cracks(mpm, cell, strain, dt, spacing, fresh);
    }
    for (std::size_t p = 0; p < points.size(); ++p)
        if (fresh[p]) points[p].crack = fresh[p];
}
} // namespace

void DenseNodal::start()
{
    for (std::size_t p = 0; p < points.size(); ++p) cells[cell_of(*this, points[p])].push_back(p);
    for (const NodalPoint& p : points) {
        basis.push_back(basis_of(*this, p));
        for (const Share& s : basis.back()) {
            nodes[s.node].level = s.level;
            nodes[s.node].mass += s.weight * p.mass;
            nodes[s.node].velocity += s.weight * p.mass * p.velocity;
        }
    }
    for (auto& [key, node] : nodes) node.velocity /= node.mass;
}

void DenseNodal::step(Real dt)
{
    push(*this, dt, all_levels);
    drift(*this, dt);
    time += dt;
    update(*this, dt, all_levels);
}

void DenseNodal::nested_step(Real dt, Slow slow)
{
    for (int n = 0; n < 1 << (levels - 1); ++n) {
        for (int l = 0; l < levels; ++l) {
            const int substeps = 1 << (levels - 1 - l);
            if (slow == Slow::frozen)
                push(*this, dt, l); // stress has not changed since the beginning of the level's step
            else if (n % substeps == 0)
                push(*this, substeps * dt, l);
        }
        drift(*this, dt);
        time += dt;
        for (int l = 0; l < levels; ++l) {
            const int substeps = 1 << (levels - 1 - l);
            if ((n + 1) % substeps == 0) update(*this, substeps * dt, l);
        }
    }
}

Vec3 DenseNodal::displacement(std::size_t point) const
{
    Vec3 sum = Vec3::Zero();
    for (const Share& s : basis[point]) sum += s.weight * nodes.at(s.node).displacement;
    return sum;
}

Vec3 DenseNodal::velocity(std::size_t point) const
{
    Vec3 sum = Vec3::Zero();
    for (const Share& s : basis[point]) sum += s.weight * nodes.at(s.node).velocity;
    return sum;
}
} // namespace support
