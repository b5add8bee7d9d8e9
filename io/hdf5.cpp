#include "io/hdf5.h"

#include "core/contract.h"
#include "core/error.h"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace io
{
namespace
{
static_assert(sizeof(hid_t) == sizeof(std::int64_t));

constexpr hsize_t chunk_values = 1 << 16; // values per chunk: 256 or 512 kB, inside the default chunk cache
constexpr unsigned deflate_level = 4;

template <class T>
hid_t native_type();
template <>
hid_t native_type<float>()
{
    return H5T_NATIVE_FLOAT;
}
template <>
hid_t native_type<double>()
{
    return H5T_NATIVE_DOUBLE;
}
template <>
hid_t native_type<std::int32_t>()
{
    return H5T_NATIVE_INT32;
}
template <>
hid_t native_type<std::uint32_t>()
{
    return H5T_NATIVE_UINT32;
}
template <>
hid_t native_type<std::int64_t>()
{
    return H5T_NATIVE_INT64;
}
template <>
hid_t native_type<std::uint64_t>()
{
    return H5T_NATIVE_UINT64;
}
template <>
hid_t native_type<std::uint8_t>()
{
    return H5T_NATIVE_UINT8;
}

template <herr_t close(hid_t)>
Hdf5Id own(hid_t id)
{
    return {id, [](std::int64_t value) -> int { return close(value); }};
}

/// The library prints its error stack to the terminal unless told not to.
void silence()
{
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

/// The innermost message of the error stack: the cause.
std::string cause()
{
    std::string text;
    const auto visit = [](unsigned, const H5E_error2_t* error, void* out) -> herr_t {
        auto& message = *static_cast<std::string*>(out);
        if (message.empty() && error->desc != nullptr) message = error->desc;
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, visit, &text);
    return text.empty() ? "unknown HDF5 error" : text;
}

/// Layout and filters of a dataset. An empty dataset cannot be chunked.
Hdf5Id creation_list(std::span<const hsize_t> shape, Hdf5Filter filter)
{
    Hdf5Id list = own<H5Pclose>(H5Pcreate(H5P_DATASET_CREATE));
    H5Pset_obj_track_times(list.get(), false); // the same data give the same bytes
    if (!list.valid() || shape[0] == 0) return list;
    std::array<hsize_t, 2> chunk{0, shape.size() > 1 ? shape[1] : 1};
    chunk[0] = std::min(shape[0], std::max<hsize_t>(1, chunk_values / chunk[1]));
    bool good = H5Pset_chunk(list.get(), static_cast<int>(shape.size()), chunk.data()) >= 0;
    if (filter == Hdf5Filter::deflate)
        good = good && H5Pset_shuffle(list.get()) >= 0 && H5Pset_deflate(list.get(), deflate_level) >= 0;
    else
        good = good && H5Pset_fletcher32(list.get()) >= 0;
    if (!good) list.reset();
    return list;
}

} // namespace

Hdf5Id::Hdf5Id(Hdf5Id&& other) noexcept
    : value_(std::exchange(other.value_, -1)), close_(std::exchange(other.close_, nullptr))
{}

Hdf5Id& Hdf5Id::operator=(Hdf5Id&& other) noexcept
{
    std::swap(value_, other.value_);
    std::swap(close_, other.close_);
    return *this;
}

int Hdf5Id::reset()
{
    if (value_ < 0) return 0;
    return close_(std::exchange(value_, -1));
}

Hdf5Writer::Hdf5Writer(const std::filesystem::path& path) : target_(path)
{
    silence();
    const Hdf5Id access = own<H5Pclose>(make_write_access(status_));
    file_ = own<H5Fclose>(H5Fcreate(target_.temporary().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()));
    if (!file_.valid()) fail("file");
}

void Hdf5Writer::fail(const std::string& what) const
{
    if (status_.error != 0) throw_file_error("write", target_.path(), status_.error);
    throw core::FileError("cannot write '" + target_.path().string() + "', " + what + ": " + cause());
}

void Hdf5Writer::group(const std::string& path)
{
    const Hdf5Id group = own<H5Gclose>(H5Gcreate2(file_.get(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    if (!group.valid()) fail("group '" + path + "'");
}

template <class T>
void Hdf5Writer::dataset(const std::string& path, std::span<const T> values, int columns, Hdf5Filter filter)
{
    CLEAVE_EXPECTS(columns > 0 && values.size() % static_cast<std::size_t>(columns) == 0);
    const auto width = static_cast<hsize_t>(columns);
    const std::array<hsize_t, 2> shape{values.size() / width, width};
    const int rank = columns > 1 ? 2 : 1;
    const Hdf5Id space = own<H5Sclose>(H5Screate_simple(rank, shape.data(), nullptr));
    const Hdf5Id list = creation_list({shape.data(), static_cast<std::size_t>(rank)}, filter);
    Hdf5Id data = own<H5Dclose>(
        H5Dcreate2(file_.get(), path.c_str(), native_type<T>(), space.get(), H5P_DEFAULT, list.get(), H5P_DEFAULT));
    const bool good = data.valid() && (values.empty() || H5Dwrite(data.get(), native_type<T>(), H5S_ALL, H5S_ALL,
                                                                  H5P_DEFAULT, values.data()) >= 0);
    if (!good || data.reset() < 0 || status_.error != 0) fail("dataset '" + path + "'");
}

template <class T>
void Hdf5Writer::attribute(const std::string& object, const std::string& name, std::span<const T> values)
{
    const hsize_t size = values.size();
    const Hdf5Id space = own<H5Sclose>(H5Screate_simple(1, &size, nullptr));
    const Hdf5Id attribute =
        own<H5Aclose>(H5Acreate_by_name(file_.get(), object.c_str(), name.c_str(), native_type<T>(), space.get(),
                                        H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    if (!attribute.valid() || H5Awrite(attribute.get(), native_type<T>(), values.data()) < 0)
        fail("attribute '" + name + "' of '" + object + "'");
}

template <class T>
requires std::is_arithmetic_v<T>
void Hdf5Writer::attribute(const std::string& object, const std::string& name, const T& value)
{
    const Hdf5Id space = own<H5Sclose>(H5Screate(H5S_SCALAR));
    const Hdf5Id attribute =
        own<H5Aclose>(H5Acreate_by_name(file_.get(), object.c_str(), name.c_str(), native_type<T>(), space.get(),
                                        H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    if (!attribute.valid() || H5Awrite(attribute.get(), native_type<T>(), &value) < 0)
        fail("attribute '" + name + "' of '" + object + "'");
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, std::string_view text)
{
    const std::string terminated(text); // H5Awrite reads the fixed length, which HDF5 wants to be at least 1
    const Hdf5Id type = own<H5Tclose>(H5Tcopy(H5T_C_S1));
    const bool typed = H5Tset_size(type.get(), std::max<std::size_t>(1, text.size())) >= 0 &&
                       H5Tset_strpad(type.get(), H5T_STR_NULLPAD) >= 0;
    const Hdf5Id space = own<H5Sclose>(H5Screate(H5S_SCALAR));
    const Hdf5Id attribute = own<H5Aclose>(H5Acreate_by_name(file_.get(), object.c_str(), name.c_str(), type.get(),
                                                             space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    if (!typed || !attribute.valid() || H5Awrite(attribute.get(), type.get(), terminated.c_str()) < 0)
        fail("attribute '" + name + "' of '" + object + "'");
}

void Hdf5Writer::commit()
{
    if (file_.reset() < 0 || status_.error != 0) fail("closing");
    target_.commit();
}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path) : path_(path)
{
    silence();
    if (!std::filesystem::exists(path)) throw_file_error("read", path, ENOENT);
    const Hdf5Id access = own<H5Pclose>(H5Pcreate(H5P_FILE_ACCESS));
    H5Pset_file_locking(access.get(), false, true); // locks fail on some network file systems; files here never change
    file_ = own<H5Fclose>(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()));
    if (!file_.valid()) fail("file");
}

void Hdf5Reader::fail(const std::string& what) const
{
    throw core::FileError("cannot read '" + path_.string() + "', " + what + ": " + cause());
}

bool Hdf5Reader::exists(const std::string& path) const
{
    return H5Lexists(file_.get(), path.c_str(), H5P_DEFAULT) > 0;
}

int Hdf5Reader::columns(const std::string& path) const
{
    const Hdf5Id data = own<H5Dclose>(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT));
    const Hdf5Id space = own<H5Sclose>(H5Dget_space(data.get()));
    std::array<hsize_t, 2> shape{};
    const int rank = H5Sget_simple_extent_ndims(space.get());
    if (rank != 1 && rank != 2) fail("dataset '" + path + "'");
    H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
    return rank == 1 ? 1 : static_cast<int>(shape[1]);
}

template <class T>
std::vector<T> Hdf5Reader::dataset(const std::string& path) const
{
    const Hdf5Id data = own<H5Dclose>(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT));
    const Hdf5Id space = own<H5Sclose>(H5Dget_space(data.get()));
    const hssize_t count = H5Sget_simple_extent_npoints(space.get());
    if (count < 0) fail("dataset '" + path + "'");
    std::vector<T> values(static_cast<std::size_t>(count));
    if (!values.empty() && H5Dread(data.get(), native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
        fail("dataset '" + path + "'");
    return values;
}

template <class T>
std::vector<T> Hdf5Reader::attribute(const std::string& object, const std::string& name) const
{
    const Hdf5Id attribute =
        own<H5Aclose>(H5Aopen_by_name(file_.get(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT));
    const Hdf5Id space = own<H5Sclose>(H5Aget_space(attribute.get()));
    const hssize_t count = H5Sget_simple_extent_npoints(space.get());
    if (count < 0) fail("attribute '" + name + "' of '" + object + "'");
    std::vector<T> values(static_cast<std::size_t>(count));
    if (H5Aread(attribute.get(), native_type<T>(), values.data()) < 0)
        fail("attribute '" + name + "' of '" + object + "'");
    return values;
}

std::string Hdf5Reader::text_attribute(const std::string& object, const std::string& name) const
{
    const Hdf5Id attribute =
        own<H5Aclose>(H5Aopen_by_name(file_.get(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT));
    const Hdf5Id type = own<H5Tclose>(H5Aget_type(attribute.get()));
    if (!type.valid() || H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) > 0)
        fail("attribute '" + name + "' of '" + object + "'");
    std::string text(H5Tget_size(type.get()), '\0');
    if (H5Aread(attribute.get(), type.get(), text.data()) < 0) fail("attribute '" + name + "' of '" + object + "'");
    text.resize(std::strlen(text.c_str()));
    return text;
}

#define CLEAVE_HDF5_ELEMENT(T)                                                                                         \
    template void Hdf5Writer::dataset(const std::string&, std::span<const T>, int, Hdf5Filter);                        \
    template void Hdf5Writer::attribute(const std::string&, const std::string&, std::span<const T>);                   \
    template void Hdf5Writer::attribute(const std::string&, const std::string&, const T&);                             \
    template std::vector<T> Hdf5Reader::dataset(const std::string&) const;                                             \
    template std::vector<T> Hdf5Reader::attribute(const std::string&, const std::string&) const;
CLEAVE_HDF5_ELEMENT(float)
CLEAVE_HDF5_ELEMENT(double)
CLEAVE_HDF5_ELEMENT(std::int32_t)
CLEAVE_HDF5_ELEMENT(std::uint32_t)
CLEAVE_HDF5_ELEMENT(std::int64_t)
CLEAVE_HDF5_ELEMENT(std::uint64_t)
CLEAVE_HDF5_ELEMENT(std::uint8_t)
#undef CLEAVE_HDF5_ELEMENT
} // namespace io
