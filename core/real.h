/// Scalar and small fixed-size types shared by every folder.
#pragma once

#include <Eigen/Core>

#include <cstdint>

using Real = double;
using Vec3 = Eigen::Vector3d;
using Index3 = Eigen::Vector3i;
