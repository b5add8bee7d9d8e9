#include "io/line_file.h"

#include "io/atomic_file.h"

#include <cerrno>
#include <fcntl.h>
#include <unistd.h>

namespace io
{
std::vector<std::string_view> complete_lines(std::string_view text)
{
    std::vector<std::string_view> lines;
    for (std::size_t end = text.find('\n'); end != text.npos; end = text.find('\n')) {
        lines.push_back(text.substr(0, end));
        text.remove_prefix(end + 1);
    }
    return lines;
}

LineFile::LineFile(std::filesystem::path path, const std::string& header, const std::vector<std::string>& lines)
    : path_(std::move(path))
{
    std::string text = header + "\n";
    for (const std::string& line : lines) text += line + "\n";
    write_file(path_, text);
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (descriptor_ < 0) throw_file_error("write", path_, errno);
}

LineFile::~LineFile()
{
    ::close(descriptor_);
}

void LineFile::append(const std::string& line)
{
    if (const int error = write_all(descriptor_, line + "\n")) throw_file_error("write", path_, error);
}
} // namespace io
