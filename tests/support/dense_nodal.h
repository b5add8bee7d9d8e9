/// The nodal scheme on one page: plain loops, doubles, nodes in a map. Ground truth for transfer/lattice.h.
///
/// Any cells of any levels, with any particles in them; hanging nodes by interpolation in the coarse cell they touch.
/// Laws are those of material/, called particle by particle.
#pragma once

#include "grid/walls.h"
#include "transfer/law_table.h"

#include <array>
#include <map>
#include <optional>
#include <vector>

namespace support
{
struct NodalPoint
{
    Vec3 rest_position = Vec3::Zero();
    Vec3 velocity = Vec3::Zero(); // at time 0
    int level = 0;                // of its cell
    Real rest_volume = 0, mass = 0, eq_plastic_strain = 0;
    std::uint8_t material = 0;
    core::Sym<Real> stress{};
    core::Mat<Real> deformation_gradient = core::identity<Real>();
    std::optional<core::Crack> crack;
};

struct DenseNodal
{
    using Node = std::array<int, 3>; // indices on the finest level
    using Cell = std::array<int, 4>; // level, then indices on it

    struct NodeState
    {
        int level = 0; // whose own node it is
        Real mass = 0;
        Vec3 force = Vec3::Zero(), velocity = Vec3::Zero(), displacement = Vec3::Zero();
    };
    /// Part of a node in the motion of one point.
    struct Share
    {
        Node node;
        int level; // of the node
        Real weight;
        Vec3 slope; // 1/mm
    };

    static constexpr int all_levels = -1;

    Real spacing0 = 0;
    int levels = 1;
    Vec3 origin = Vec3::Zero(), gravity = Vec3::Zero();
    std::vector<grid::WallPlane> walls;
    transfer::LawTable laws;
    std::vector<NodalPoint> points; // in the order of the particles

    std::map<Node, NodeState> nodes;
    std::map<Cell, std::vector<std::size_t>> cells; // points of a cell
    std::vector<std::vector<Share>> basis;          // [point]
    Real time = 0, plastic_work = 0, decohesion_work = 0;

    /// How a slow force reaches the nodes: all of it at the beginning of its step, or the same in every fine step.
    enum class Slow
    {
        impulse,
        frozen, // the natural wrong way: unstable (methods.md A.7)
    };

    void start();
    void step(Real dt);
    /// Sub-cycled step of the coarsest level; dt is that of the finest.
    void nested_step(Real dt, Slow slow = Slow::impulse);
    Vec3 displacement(std::size_t point) const;
    Vec3 velocity(std::size_t point) const;
};
} // namespace support
