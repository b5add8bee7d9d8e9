/// What makes scenes alike: read from the case, so that measurements on one scene say something about another.
#pragma once

#include "solver/problem.h"

#include <string>

namespace app
{
struct SceneFeatures
{
    bool contact = false;      // bodies that are apart at time 0
    bool large_motion = false; // bodies or loads travel further than the smallest side, or the case asks for `updated`
    bool plastic = false;
    bool crack = false;     // decohesion with a finite strength
    bool localised = false; // refinement zones or holes: something small in something large
    Real length = 0;        // mm, what the cells have to resolve: smallest hole, else smallest side of a body that is
                            // more than one cell wide (slabs of plane problems)
};

SceneFeatures scene_features(const solver::Problem& problem);

/// "plasticity, crack, localised feature", or "small elastic motion".
std::string features_text(const SceneFeatures& features);
} // namespace app
