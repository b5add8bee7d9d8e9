/// The material point method on one level, on one page: plain loops, nodes in a map. Ground truth for the real code.
///
/// Trilinear weights; FLIP/PIC or APIC; stress last or after a second mapping; updated or total Lagrangian; J2 with
/// linear hardening on Hughes-Winget increments; dilatation averaged over the particles of a cell where asked.
#pragma once

#include "material/material.h"
#include "transfer/passes.h"

#include <Eigen/LU>

#include <map>
#include <tuple>
#include <vector>

namespace support
{
struct DensePoint
{
    Vec3 position, rest_position, velocity = Vec3::Zero();
    Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d deformation_gradient = Eigen::Matrix3d::Identity();
    Eigen::Matrix3d affine = Eigen::Matrix3d::Zero(); // 1/ms; FLIP leaves it zero
    Real volume_ratio = 1, rest_volume = 0, mass = 0, eq_plastic_strain = 0;
    std::size_t material = 0;
};

struct DenseMpm
{
    Real spacing = 0;
    Vec3 origin = Vec3::Zero();
    transfer::PassOptions options;
    std::vector<material::Material> materials;
    std::vector<DensePoint> points;
    Real plastic_work = 0; // mJ

    void step(Real dt);
};
} // namespace support
