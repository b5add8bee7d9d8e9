/// Which of its builds of the kernels the loader has taken (cmake/Module.cmake).
#pragma once

#include <string_view>

namespace transfer
{
/// The instruction set these kernels are compiled for: x86-64, x86-64-v3 or x86-64-v4; "baseline" on other processors.
std::string_view kernel_level();
} // namespace transfer
