#include "tests/support/dense_mpm.h"

#include <array>
#include <cmath>

namespace support
{
namespace
{
using Matrix = Eigen::Matrix3d;
using Key = std::tuple<int, int, int>;

struct Node
{
    Real mass = 0;
    Vec3 momentum = Vec3::Zero(), force = Vec3::Zero(), velocity = Vec3::Zero(), change = Vec3::Zero(),
         remapped = Vec3::Zero();
};

struct Corner
{
    Key key;
    Vec3 from_point; // mm, node minus point
    Real weight;
    Vec3 slope; // 1/mm
};

/// Cell of a point and the corners it weighs on; a box has those of all its sub-boxes.
struct Place
{
    Key cell;
    std::vector<Corner> corner;
};

/// Add the corners of the cell of `at`, weighed by `share`, for a point at `x`.
void add_corners(const Vec3& at, Real share, const Vec3& x, const Vec3& origin, Real h, Place& place)
{
    const Vec3 scaled = (at - origin) / h;
    const Vec3 lower = scaled.array().floor();
    for (int c = 0; c < 8; ++c) {
        const Vec3 bit(c >> 2, c >> 1 & 1, c & 1);
        const Vec3 t = scaled - lower;
        Vec3 w, d;
        for (int a = 0; a < 3; ++a) {
            w[a] = bit[a] > 0 ? t[a] : 1 - t[a];
            d[a] = (bit[a] > 0 ? 1 : -1) / h;
        }
        const Vec3 node = lower + bit;
        place.corner.push_back({{int(node[0]), int(node[1]), int(node[2])},
                                origin + h * node - x,
                                share * w.prod(),
                                share * Vec3(d[0] * w[1] * w[2], w[0] * d[1] * w[2], w[0] * w[1] * d[2])});
    }
}

/// Centre and length of [x - half, x + half] below and above the next plane of cells.
std::array<std::array<Real, 2>, 2> halves(Real x, Real half, Real origin, Real h)
{
    const Real plane = origin + h * std::round((x - origin) / h);
    const Real cut = std::min(std::max(plane, x - half), x + half);
    return {{{(x - half + cut) / 2, cut - x + half}, {(cut + x + half) / 2, x + half - cut}}};
}

/// Boxes have half width `half`; 0: a point.
Place place_of(const Vec3& x, Real half, const Vec3& origin, Real h)
{
    const Vec3 lower = ((x - origin) / h).array().floor();
    Place place{{int(lower[0]), int(lower[1]), int(lower[2])}, {}};
    if (half == 0) {
        add_corners(x, 1, x, origin, h, place);
        return place;
    }
    for (const auto& i : halves(x[0], half, origin[0], h))
        for (const auto& j : halves(x[1], half, origin[1], h))
            for (const auto& k : halves(x[2], half, origin[2], h)) {
                const Real share = i[1] * j[1] * k[1] / (8 * half * half * half);
                if (share > 0) add_corners({i[0], j[0], k[0]}, share, x, origin, h, place);
            }
    return place;
}

Matrix hughes_winget(const Matrix& increment)
{
    const Matrix half = 0.25 * (increment - increment.transpose());
    return (Matrix::Identity() - half).inverse() * (Matrix::Identity() + half);
}

/// Radial return of a trial stress; returns the plastic work per volume.
Real return_to_yield(const material::Material& m, DensePoint& p)
{
    if (!m.plastic) return 0;
    const Real mean = p.stress.trace() / 3;
    const Matrix deviator = p.stress - mean * Matrix::Identity();
    const Real equivalent = std::sqrt(1.5) * deviator.norm();
    const Real hardening = m.plastic->plastic_modulus(m.elastic.youngs_modulus);
    const Real strength = m.plastic->yield_stress + hardening * p.eq_plastic_strain;
    if (equivalent <= strength) return 0;
    const Real flow = (equivalent - strength) / (3 * m.elastic.shear_modulus() + hardening);
    p.stress = mean * Matrix::Identity() + (1 - 3 * m.elastic.shear_modulus() * flow / equivalent) * deviator;
    p.eq_plastic_strain += flow;
    return flow * (strength + hardening * flow / 2);
}
} // namespace

void DenseMpm::step(Real dt)
{
    const bool total = options.formulation == transfer::Formulation::total;
    const bool apic = options.transfer == transfer::Transfer::apic;
    const bool musl = options.stress_update == transfer::StressUpdate::musl;
    std::map<Key, Node> nodes;
    std::vector<Place> places;
    for (const DensePoint& p : points)
        places.push_back(place_of(total ? p.rest_position : p.position,
                                  uses_boxes(options) ? spacing / (2 * options.per_axis) : 0, origin, spacing));
    const auto averaged = [&](const DensePoint& p) { return materials[p.material].cell_averaged_dilatation; };
    const auto collapsed = [&](const DensePoint& p, Real volume) {
        return total && volume < transfer::least_averaged_volume * p.rest_volume;
    };

    // The updated formulation averages the pressure too: the adjoint of averaging the dilatation.
    std::map<Key, std::array<Real, 2>> pressure;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (total || !averaged(points[i])) continue;
        const Real volume = points[i].rest_volume * points[i].volume_ratio;
        pressure[places[i].cell][0] += volume;
        pressure[places[i].cell][1] += volume * points[i].stress.trace() / 3;
    }
    const auto add_momentum = [&](std::size_t i) {
        const DensePoint& p = points[i];
        for (const Corner& c : places[i].corner)
            nodes[c.key].momentum += p.mass * c.weight * (p.velocity + p.affine * c.from_point);
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        const DensePoint& p = points[i];
        Matrix flux = p.rest_volume * p.volume_ratio * p.stress;
        if (total) {
            const Matrix& f = p.deformation_gradient;
            flux = p.rest_volume * f.determinant() * p.stress * f.inverse().transpose();
        } else if (averaged(p)) {
            const auto& [volume, sum] = pressure[places[i].cell];
            flux += p.rest_volume * p.volume_ratio * (sum / volume - p.stress.trace() / 3) * Matrix::Identity();
        }
        for (const Corner& c : places[i].corner) {
            nodes[c.key].mass += p.mass * c.weight;
            nodes[c.key].force -= flux * c.slope;
        }
        add_momentum(i);
    }
    for (auto& [key, n] : nodes) {
        n.change = dt * n.force / n.mass;
        n.velocity = n.momentum / n.mass + n.change;
    }

    const auto affine_of = [&](std::size_t i) -> Matrix {
        Matrix moment = Matrix::Zero(), inertia = Matrix::Zero();
        for (const Corner& c : places[i].corner) {
            moment += c.weight * nodes[c.key].velocity * c.from_point.transpose();
            inertia += c.weight * c.from_point * c.from_point.transpose();
        }
        return moment * inertia.inverse();
    };
    std::vector<Matrix> gradient(points.size(), Matrix::Zero());
    std::vector<Vec3> grid_velocity(points.size(), Vec3::Zero());
    for (std::size_t i = 0; i < points.size(); ++i) {
        DensePoint& p = points[i];
        Vec3 change = Vec3::Zero();
        for (const Corner& c : places[i].corner) {
            const Node& n = nodes[c.key];
            grid_velocity[i] += c.weight * n.velocity;
            change += c.weight * n.change;
            gradient[i] += n.velocity * c.slope.transpose();
        }
        const Vec3 flip = p.velocity + change;
        p.velocity = apic ? grid_velocity[i] : Vec3(flip + options.pic_fraction * (grid_velocity[i] - flip));
        if (apic) p.affine = uses_boxes(options) ? affine_of(i) : gradient[i];
    }
    if (musl) {
        for (auto& [key, n] : nodes) n.momentum.setZero();
        for (std::size_t i = 0; i < points.size(); ++i) add_momentum(i);
        for (std::size_t i = 0; i < points.size(); ++i) {
            gradient[i].setZero();
            for (const Corner& c : places[i].corner)
                gradient[i] += nodes[c.key].momentum / nodes[c.key].mass * c.slope.transpose();
        }
    }

    // Strain increments at the middle of the step, then their dilatation averaged over each cell.
    std::vector<Matrix> increment(points.size());
    std::vector<Real> volume(points.size());
    std::map<Key, std::array<Real, 2>> dilatation;
    for (std::size_t i = 0; i < points.size(); ++i) {
        DensePoint& p = points[i];
        p.position += dt * grid_velocity[i];
        increment[i] = dt * gradient[i];
        if (total) {
            const Matrix middle = p.deformation_gradient + increment[i] / 2;
            p.deformation_gradient += increment[i];
            volume[i] = p.rest_volume * middle.determinant();
            increment[i] *= middle.inverse();
        } else {
            const Real half = increment[i].trace() / 2, before = p.volume_ratio;
            p.volume_ratio *= (1 + half) / (1 - half);
            volume[i] = p.rest_volume * (before + p.volume_ratio) / 2;
        }
        if (!averaged(p) || collapsed(p, volume[i])) continue;
        dilatation[places[i].cell][0] += volume[i];
        dilatation[places[i].cell][1] += volume[i] * increment[i].trace();
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        DensePoint& p = points[i];
        const material::Material& m = materials[p.material];
        Matrix strain = (increment[i] + increment[i].transpose()) / 2;
        if (averaged(p) && !collapsed(p, volume[i])) {
            const auto& [cell_volume, sum] = dilatation[places[i].cell];
            strain += (sum / cell_volume - increment[i].trace()) / 3 * Matrix::Identity();
        }
        const Matrix rotation = hughes_winget(increment[i]);
        const Matrix spin = (increment[i] - increment[i].transpose()) / 2;
        strain = (strain + (spin * strain - strain * spin) / 2).eval(); // from mid-step to its end
        p.stress = rotation * p.stress * rotation.transpose() + m.elastic.lame() * strain.trace() * Matrix::Identity() +
                   2 * m.elastic.shear_modulus() * strain;
        plastic_work += volume[i] * return_to_yield(m, p);
    }
}
} // namespace support
