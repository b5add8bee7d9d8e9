#include "io/atomic_file.h"

#include "core/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace io
{
namespace
{
constexpr std::string_view mark = ".", ending = ".tmp"; // around the name of a temporary

/// An open file descriptor.
class Descriptor
{
public:
    Descriptor(const std::filesystem::path& path, int flags) : value_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
    ~Descriptor()
    {
        if (value_ >= 0) ::close(value_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    explicit operator bool() const { return value_ >= 0; }
    int get() const { return value_; }
    /// @return 0, or errno: a quota or a network file system may report a lost write only here
    int close()
    {
        const int status = ::close(std::exchange(value_, -1));
        return status == 0 ? 0 : errno;
    }

private:
    int value_;
};

/// Make a rename durable. Some file systems refuse to sync a directory; the data are safe all the same.
void sync_directory(const std::filesystem::path& path)
{
    const Descriptor directory(path.empty() ? "." : path, O_RDONLY | O_DIRECTORY);
    if (directory) ::fsync(directory.get());
}
} // namespace

void throw_file_error(std::string_view verb, const std::filesystem::path& path, int error)
{
    throw core::FileError("cannot " + std::string(verb) + " '" + path.string() + "': " + std::strerror(error));
}

void make_directory(const std::filesystem::path& path)
{
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error) throw_file_error("create directory", path, error.value());
    if (!std::filesystem::is_directory(path, error)) throw_file_error("create directory", path, ENOTDIR);
}

std::string read_file(const std::filesystem::path& path)
{
    const Descriptor file(path, O_RDONLY);
    if (!file) throw_file_error("read", path, errno);
    std::string text;
    char block[1 << 16];
    while (true) {
        const ssize_t count = ::read(file.get(), block, sizeof(block));
        if (count == 0) return text;
        if (count > 0)
            text.append(block, static_cast<std::size_t>(count));
        else if (errno != EINTR)
            throw_file_error("read", path, errno);
    }
}

int write_all(int descriptor, std::string_view text)
{
    while (!text.empty()) {
        const ssize_t count = ::write(descriptor, text.data(), text.size());
        if (count >= 0)
            text.remove_prefix(static_cast<std::size_t>(count));
        else if (errno != EINTR)
            return errno;
    }
    return 0;
}

void write_file(const std::filesystem::path& path, std::string_view text)
{
    AtomicFile target(path);
    Descriptor file(target.temporary(), O_WRONLY | O_CREAT | O_TRUNC);
    if (!file) throw_file_error("write", path, errno);
    if (const int error = write_all(file.get(), text)) throw_file_error("write", path, error);
    if (const int error = file.close()) throw_file_error("write", path, error);
    target.commit();
}

std::filesystem::path name_of_temporary(const std::filesystem::path& temporary)
{
    std::string name = temporary.filename().string();
    const std::size_t added = mark.size() + ending.size();
    if (name.size() <= added || !name.starts_with(mark) || !name.ends_with(ending)) return {};
    return name.substr(mark.size(), name.size() - added);
}

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)),
      temporary_(path_.parent_path() / fmt::format("{}{}{}", mark, path_.filename().string(), ending))
{}

AtomicFile::~AtomicFile()
{
    std::error_code ignored; // after a commit there is nothing to remove
    std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::commit()
{
    Descriptor file(temporary_, O_RDWR);
    if (!file) throw_file_error("write", path_, errno);
    if (::fsync(file.get()) != 0) throw_file_error("write", path_, errno);
    if (const int error = file.close()) throw_file_error("write", path_, error);
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) throw_file_error("write", path_, errno);
    sync_directory(path_.parent_path());
}
} // namespace io
