/// Files that are either complete or absent: written under a temporary name in the same directory, synced, renamed.
///
/// A reader never sees half a file under the final name, whatever happens to the writer. Every error is a
/// core::FileError with the path and the reason of the operating system.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace io
{
/// Throw a core::FileError "cannot <verb> '<path>': <reason>"; the reason is strerror of `error`.
[[noreturn]] void throw_file_error(std::string_view verb, const std::filesystem::path& path, int error);

/// Make a directory and its parents.
/// @error FileError if that fails or a file is in the way
void make_directory(const std::filesystem::path& path);

/// The whole text of a file.
/// @error FileError
std::string read_file(const std::filesystem::path& path);

/// Write all of `text` to an open file descriptor.
/// @return 0, or the errno of the first failed write
int write_all(int descriptor, std::string_view text);

/// Replace a file by `text`, atomically.
/// @error FileError; the old file is then unchanged and no temporary is left
void write_file(const std::filesystem::path& path, std::string_view text);

/// The file name that a temporary would get; empty if the path is none.
std::filesystem::path name_of_temporary(const std::filesystem::path& temporary);

/// A temporary name beside a final one, for writers that open the file themselves (HDF5, OpenVDB).
///
/// The temporary is hidden (".name.tmp"), so no pattern such as *.hdf matches it. Destroying without commit removes it;
/// what a killed run leaves is overwritten by the next writer of the same file (those of numbered files:
/// io/numbered_files.h).
class AtomicFile
{
public:
    explicit AtomicFile(std::filesystem::path path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    const std::filesystem::path& temporary() const { return temporary_; }

    /// Sync the closed temporary to disk and give it its final name.
    /// @error FileError; the temporary is then removed
    void commit();

private:
    std::filesystem::path path_;
    std::filesystem::path temporary_;
};
} // namespace io
