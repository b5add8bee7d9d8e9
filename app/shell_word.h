/// A word for a POSIX shell.
#pragma once

#include <string>

namespace app
{
/// In single quotes, those in it escaped: one word whatever it holds.
inline std::string shell_word(const std::string& word)
{
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}
} // namespace app
