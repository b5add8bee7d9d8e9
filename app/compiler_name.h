/// What this program was built with.
#pragma once

#include <string>

namespace app
{
/// Such as "g++ 12.2.0".
inline std::string compiler_name()
{
#ifdef __clang__
    return "clang " __clang_version__;
#else
    return "g++ " __VERSION__;
#endif
}
} // namespace app
