/// One exception type per cause; app/main.cpp turns each into its exit code. Nothing else prints or exits.
#pragma once

#include <stdexcept>
#include <string>

namespace core
{
/// The user's input is wrong (exit code 2). The text is complete: where, what was read, what was expected.
struct InputError : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

/// The computation left the range where its numbers mean anything (exit code 3): NaN, a particle that flew away.
struct NumericalError : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

/// A file could not be read or written completely (exit code 4).
struct FileError : std::runtime_error
{
    using std::runtime_error::runtime_error;
};
} // namespace core
