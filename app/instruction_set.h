/// Names of what this program was built with and runs on.
#pragma once

#include <string>

namespace app
{
/// Instruction set the dynamic loader chooses kernels by (cmake/Module.cmake): x86-64, x86-64-v3, x86-64-v4.
std::string instruction_set();

/// Such as "g++ 12.2.0".
std::string compiler_name();
} // namespace app
