/// The commit this program was built from; the build writes the definition (cmake/Commit.cmake).
#pragma once

#include <string>

namespace app
{
/// Such as "b149e1b2af", or "b149e1b2af with changes"; empty if it was not built in a checkout.
std::string commit();

/// Version and commit, such as "0.1.0 (b149e1b2af)".
inline std::string version_text()
{
    return commit().empty() ? CLEAVE_VERSION : CLEAVE_VERSION " (" + commit() + ")";
}
} // namespace app
