/// The case `cleave new` writes: a notched bar, small enough to run in a minute, with every key explained.
#pragma once

#include <string>

namespace app
{
/// A complete case file; what is optional and left out stands there as a comment with default and meaning.
std::string case_template(const std::string& name);
} // namespace app
