/// A growing CSV file whose lines begin with their step. Every line reaches the operating system at once, so a running
/// case can be plotted and a killed one loses nothing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace io
{
/// The complete lines of a text; what follows the last end of line was cut short.
std::vector<std::string_view> complete_lines(std::string_view text);

class LineFile
{
public:
    /// Start a new file, replacing an old one.
    LineFile(std::filesystem::path path, const std::string& header);
    /// Go on with an existing file after `step`: later lines, and one cut short, are dropped. Without a file: a new
    /// one.
    LineFile(std::filesystem::path path, const std::string& header, std::int64_t step);
    ~LineFile();
    LineFile(const LineFile&) = delete;
    LineFile& operator=(const LineFile&) = delete;

    /// Append one line, given without its end.
    /// @error FileError
    void append(const std::string& line);

private:
    void open();

    std::filesystem::path path_;
    int descriptor_ = -1;
};
} // namespace io
