/// A growing CSV file. Every line reaches the operating system at once, so a running
/// case can be plotted and a killed one loses nothing.
#pragma once

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
    /// Replace the file by a header and the lines there are already.
    LineFile(std::filesystem::path path, const std::string& header, const std::vector<std::string>& lines);
    ~LineFile();
    LineFile(const LineFile&) = delete;
    LineFile& operator=(const LineFile&) = delete;

    /// Append one line, given without its end.
    /// @error FileError
    void append(const std::string& line);

private:
    std::filesystem::path path_;
    int descriptor_ = -1;
};
} // namespace io
