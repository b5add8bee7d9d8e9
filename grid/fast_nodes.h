/// Sub-cycling (methods.md A.7): nodes that change their velocity within the step of their level, because finer
/// particles push them through slaves, or a load holds them. They drift with the finest step, all others of their level
/// once.
#pragma once

#include "grid/levels.h"

namespace grid
{
struct FastNode
{
    NodeAddress at;
    std::array<Real, 3> begin;    // mm, displacement at the beginning of the step of its level
    std::array<Real, 3> now;      // mm, displacement
    std::array<Real, 3> velocity; // mm/ms, kept while the tile holds the mean over the step
};

/// [level] nodes, ascending; none on the finest level.
using FastNodes = std::vector<std::vector<FastNode>>;

/// Masters that move, and the held nodes; at the end of a step of all levels.
FastNodes find_fast_nodes(const Levels& levels, const std::vector<NodeAddress>& held);

/// u += dt v for all of them, whatever the step of their level has put into the tile.
void drift_fast_nodes(Real dt, Levels& levels, FastNodes& fast);

/// The step of the levels of `steps` ends: put their nodes' mean velocity over it into the tiles, for the particles.
void average_fast_nodes(const LevelSteps& steps, Levels& levels, FastNodes& fast);

/// The velocity itself again, and a new step begins.
void release_fast_nodes(const LevelSteps& steps, Levels& levels, FastNodes& fast);
} // namespace grid
