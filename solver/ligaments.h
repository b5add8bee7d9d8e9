/// When a ligament between two features begins to crack, is cut through its thickness, and is separated.
///
/// A ligament's corridor is divided into columns along the thickness, one finest cell wide, on the reference lattice. A
/// column is broken when `broken_share` of the rest volume in it belongs to separated particles. The ligament is
/// through when broken columns that touch at least by a corner lead from one feature to the other, or when cells broken
/// in the same sense (of a cell's eight particles all) do so in `broken_share` of the layers across the thickness: a
/// slanted crack leaves no column whole and breaks none; its first broken column is noted when it is through.
///
/// The columns of one ligament never change, only their contents and the layers that hold some: splitting and
/// reordering of particles do not matter. Neglected: particles more than one level coarser than the finest leave gaps
/// between their columns; every layer is looked at by itself, so cuts that take different routes in neighbouring
/// layers, and leave metal between them that still shears, count as one.
#pragma once

#include "particles/particles.h"
#include "solver/problem.h"
#include "solver/state.h"

#include <cstdint>
#include <vector>

namespace solver
{
/// Share of a column's rest volume that must be separated: not all, because cut cells at a surface or single particles
/// between two planes may stay intact without carrying the ligament.
inline constexpr Real broken_share = 0.9;
/// A column this close to a feature [columns] touches it: its own half width and one cut column.
inline constexpr Real touching_distance = 1.5;

/// The columns of one corridor, a rectangle of them with a mask.
struct LigamentColumns
{
    int axis_u = 0, axis_v = 1;    // the plane normal to the thickness, cyclic order
    int axis_w = 2;                // the thickness
    Real spacing = 0;              // mm, finest
    Real lower_u = 0, lower_v = 0; // mm, corner of column (0, 0), on the reference lattice
    int count_u = 0, count_v = 0;
    std::vector<std::uint8_t> inside;       // [u * count_v + v] 1: centre in the corridor
    std::vector<std::uint8_t> touches_from; // likewise, 1: touches feature `from`
    std::vector<std::uint8_t> touches_to;   // likewise
    std::vector<std::int32_t> station;      // likewise, position along the line from `from` to `to`, in columns
    Real origin_w = 0;                      // mm, of the lattice along the thickness
    // By weigh_columns:
    std::vector<Real> volume;      // likewise, mm^3, rest volume of its particles
    Real lower_w = 0;              // mm, of the lowest layer with particles
    int layers = 0;                // across the thickness, one finest cell each; 0: no particles
    std::vector<Real> cell_volume; // mm^3, [layer * columns + column], rest volume of its particles

    /// Column of a rest position, -1 outside of the corridor.
    std::int32_t column(Real u, Real v) const;
    /// Place in `cell_volume` of a cell of the column.
    std::size_t cell(std::int32_t column, Real w) const;
};

/// Geometry of every ligament of a problem, in its order; built once, weighed whenever particles were split.
struct LigamentMap
{
    std::vector<LigamentColumns> ligaments;
};

/// @pre corridors are polygons of at least three corners; `from` and `to` name features of the problem
LigamentMap ligament_map(const Problem& problem);

/// Rest volume of every column and of its cells; again whenever particles were split.
void weigh_columns(const particles::Particles& particles, LigamentMap& map);

/// What is written down when something happens.
struct Observation
{
    Real time = 0;  // ms
    Real force = 0; // N, full specimen
    Real cod = 0;   // mm
};

/// Update the state of every ligament: onset, first broken column, separation, each once, and the front: the share of
/// stations along the ligament that have a broken column.
/// @param ligaments  resized to the map if empty
/// @pre   weigh_columns
/// @cost  a look at every particle's crack index; once some particle has a crack, a number per cell of every ligament
void update_ligaments(const LigamentMap& map, const particles::Particles& particles, const Observation& now,
                      std::vector<LigamentState>& ligaments);

/// Ligaments (indices) a crack ran through, in the order it ran, and the features it visited.
struct CrackPath
{
    std::vector<std::size_t> ligaments;
    std::vector<std::string> features; // start first; empty when no ligament at a start feature is through
};

/// From the start feature, follow again and again the separated ligament at the present feature that separated first
/// and leads to a feature not yet visited; ligaments may be passed in both directions. Of several start features the
/// one whose ligament separated first counts.
CrackPath crack_path(const std::vector<Ligament>& names, const std::vector<LigamentState>& states,
                     const std::vector<std::string>& start_features);

/// "A-D-C-E"; empty for an empty path.
std::string path_name(const CrackPath& path);
} // namespace solver
