#include "io/line_file.h"

#include "io/atomic_file.h"

#include <cerrno>
#include <charconv>
#include <fcntl.h>
#include <unistd.h>

namespace io
{
namespace
{
/// Whether the line begins with a step, and one that is not later.
bool kept(std::string_view line, std::int64_t step)
{
    std::int64_t own = 0; // the header has none
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), own);
    return error == std::errc() && end < line.data() + line.size() && *end == ',' && own <= step;
}
} // namespace

std::vector<std::string_view> complete_lines(std::string_view text)
{
    std::vector<std::string_view> lines;
    for (std::size_t end = text.find('\n'); end != text.npos; end = text.find('\n')) {
        lines.push_back(text.substr(0, end));
        text.remove_prefix(end + 1);
    }
    return lines;
}

LineFile::LineFile(std::filesystem::path path, const std::string& header) : path_(std::move(path))
{
    write_file(path_, header + "\n");
    open();
}

LineFile::LineFile(std::filesystem::path path, const std::string& header, std::int64_t step) : path_(std::move(path))
{
    const std::string old = std::filesystem::exists(path_) ? read_file(path_) : std::string();
    std::string text = header + "\n";
    for (const std::string_view line : complete_lines(old))
        if (kept(line, step)) text.append(line).append("\n");
    write_file(path_, text);
    open();
}

LineFile::~LineFile()
{
    ::close(descriptor_);
}

void LineFile::open()
{
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (descriptor_ < 0) throw_file_error("write", path_, errno);
}

void LineFile::append(const std::string& line)
{
    if (const int error = write_all(descriptor_, line + "\n")) throw_file_error("write", path_, error);
}
} // namespace io
