/// HDF5 files: a writer and a reader over the C API, with errors as core::FileError that name file and object.
///
/// Paths inside a file are absolute, such as "/VTKHDF/Points". A dataset is [n] or, with several columns, [n][columns].
/// Element types: float, double, int32, uint32, int64, uint64, uint8. HDF5 is not thread-safe here: one thread at a
/// time.
#pragma once

#include "io/atomic_file.h"
#include "io/hdf5_driver.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace io
{
/// What happens to the bytes of a dataset on their way to disk.
enum class Hdf5Filter
{
    deflate,  // shuffle + deflate: small, for results
    checksum, // Fletcher32, no compression: fast, damage is found when reading; for checkpoints
};

/// Owns one HDF5 identifier and the function that closes it.
class Hdf5Id
{
public:
    using Close = int (*)(std::int64_t);
    Hdf5Id() = default;
    Hdf5Id(std::int64_t value, Close close) : value_(value), close_(close) {}
    Hdf5Id(Hdf5Id&& other) noexcept;
    Hdf5Id& operator=(Hdf5Id&& other) noexcept;
    ~Hdf5Id() { reset(); }
    std::int64_t get() const { return value_; }
    bool valid() const { return value_ >= 0; }
    /// @return negative if closing failed
    int reset();

private:
    std::int64_t value_ = -1;
    Close close_ = nullptr;
};

/// Writes one new file, which appears under its name only by `commit`.
class Hdf5Writer
{
public:
    /// @error FileError if the temporary file cannot be made
    explicit Hdf5Writer(const std::filesystem::path& path);

    /// Make a group; its parent must exist.
    void group(const std::string& path);

    /// Write a dataset of values.size() / columns rows.
    /// @pre columns divides the number of values
    /// @error FileError, also when the disk is full
    template <class T>
    void dataset(const std::string& path, std::span<const T> values, int columns = 1,
                 Hdf5Filter filter = Hdf5Filter::deflate);

    /// Attach a vector of numbers to a group or dataset ("/" is the file).
    template <class T>
    void attribute(const std::string& object, const std::string& name, std::span<const T> values);
    /// Attach one number.
    template <class T>
    requires std::is_arithmetic_v<T>
    void attribute(const std::string& object, const std::string& name, const T& value);
    /// Attach fixed-length ASCII text, the kind VTKHDF asks for.
    void attribute(const std::string& object, const std::string& name, std::string_view text);

    /// Close, sync, rename.
    /// @error FileError; nothing is left under the final name
    void commit();

private:
    [[noreturn]] void fail(const std::string& what) const;

    AtomicFile target_;
    WriteStatus status_;
    Hdf5Id file_; // destroyed before status_, which its driver writes to
};

/// Reads one file.
class Hdf5Reader
{
public:
    /// @error FileError if it is missing, truncated or no HDF5 file
    explicit Hdf5Reader(const std::filesystem::path& path);

    const std::filesystem::path& path() const { return path_; }
    /// Does a group or dataset exist? Its parent must.
    bool exists(const std::string& path) const;
    /// Number of columns of a dataset (1 for a one-dimensional one).
    int columns(const std::string& path) const;
    /// All values, row by row, converted to T.
    /// @error FileError if the dataset is missing or its checksum is wrong
    template <class T>
    std::vector<T> dataset(const std::string& path) const;
    template <class T>
    std::vector<T> attribute(const std::string& object, const std::string& name) const;
    std::string text_attribute(const std::string& object, const std::string& name) const;

private:
    [[noreturn]] void fail(const std::string& what) const;

    std::filesystem::path path_;
    Hdf5Id file_;
};
} // namespace io
