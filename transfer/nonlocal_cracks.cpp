#include "transfer/nonlocal_cracks.h"

#include "material/decohesion.h"
#include "transfer/chunk.h"
#include "transfer/middle_gradient.h"

namespace transfer
{
namespace
{
constexpr Real rounding = 1e-6; // 1, of comparisons between places on the lattice
} // namespace

CellMotion motion_of(const NonlocalView& view, const particles::Particles& particles, std::size_t slot)
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
    CellMotion motion{gradient(velocity_column), core::identity<Real>()};
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

Vec3 at_rest(const core::Mat<Real>& deformation, const std::array<Real, 3>& normal)
{
    Vec3 rest = Vec3::Zero();
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) rest[a] += deformation(b, a) * normal[static_cast<std::size_t>(b)];
    return rest.normalized();
}

std::vector<Neighbour> cracks_near(const NonlocalView& view, const particles::Particles& particles, std::size_t slot,
                                   Real reach)
{
    const OccupiedCell own = occupied_cell(view.levels, slot);
    std::vector<Neighbour> neighbours;
    for (const Seen& image : images_of(view.options, view.levels, centre_of(view.levels, own), reach))
        for (const OccupiedCell& cell : cells_near(view.levels, image.place, reach, 0))
            for (std::uint32_t p = view.levels.cell_start[cell.slot]; p < view.levels.cell_start[cell.slot + 1]; ++p) {
                if (particles.crack[p] < 0) continue;
                const core::Crack& crack = particles.cracks[static_cast<std::size_t>(particles.crack[p])];
                const Vec3 normal = turned_over(image.turned, Vec3(crack.normal[0], crack.normal[1], crack.normal[2]));
                neighbours.push_back({turned_over(image.turned, image.place - centre_of(view.levels, cell)),
                                      cell.slot,
                                      {normal[0], normal[1], normal[2]},
                                      crack.effective_length});
                break;
            }
    return neighbours;
}

bool softens(const NonlocalView& view, const particles::Particles& particles, std::size_t slot)
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

std::vector<Vec3> arriving_cracks(const NonlocalView& view, const particles::Particles& particles, std::size_t slot)
{
    const Real spacing = view.levels.spacing(view.levels.leaves[slot / grid::leaf_cells].level);
    const Real beside = Real(1.6) * spacing; // a coarser neighbour's centre is at 1.5
    const core::Mat<Real> deformation = motion_of(view, particles, slot).deformation;
    std::vector<Vec3> ways;
    for (const Neighbour& other : cracks_near(view, particles, slot, beside)) {
        if (other.offset.squaredNorm() == 0 || other.offset.cwiseAbs().maxCoeff() > beside) continue;
        const Vec3 normal = at_rest(deformation, other.normal);
        const Real across = other.offset.dot(normal);
        if (2 * across * across <= (1 + rounding) * other.offset.squaredNorm())
            ways.push_back((other.offset - across * normal).normalized());
    }
    return ways;
}

bool excluded(const Vec3& offset, const Vec3& normal, const Vec3& fresh, Real band, Real reach)
{
    const Real across = std::abs(offset.dot(normal));
    const Real along = (offset - offset.dot(normal) * normal).norm();
    return across > (1 + rounding) * band / 2 && across < (1 - rounding) * reach && along < (1 - rounding) * band &&
           std::abs(normal.dot(fresh)) > std::sqrt(Real(0.5));
}
} // namespace transfer
