/// Versions of the libraries this program was built with, for `cleave info` and bug reports.
#pragma once

#include <string>

namespace io
{
/// "OpenVDB 10.0.1, HDF5 1.10.8, ...".
std::string library_versions();
} // namespace io
