#include "io/library_versions.h"

#include <Eigen/Core>
#include <H5public.h>
#include <fmt/format.h>
#include <openvdb/version.h>
#include <tbb/version.h>

namespace io
{
std::string library_versions()
{
    return fmt::format("OpenVDB {}, HDF5 {}.{}.{}, TBB {}.{}, Eigen {}.{}.{}, fmt {}.{}.{}",
                       OPENVDB_LIBRARY_VERSION_STRING, H5_VERS_MAJOR, H5_VERS_MINOR, H5_VERS_RELEASE, TBB_VERSION_MAJOR,
                       TBB_VERSION_MINOR, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION,
                       FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100);
}
} // namespace io
