#include "io/hdf5_driver.h"

#include <hdf5.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <new>
#include <sys/stat.h>
#include <unistd.h>

namespace io
{
namespace
{
/// The driver's part of a property list.
struct Access
{
    WriteStatus* status;
};

/// An open file; the public part must come first, HDF5 casts between the two.
struct DriverFile
{
    H5FD_t base;
    int descriptor;
    haddr_t end_allocated; // bytes the library asked for
    haddr_t end_written;   // bytes the library believes are in the file
    WriteStatus* status;
};

DriverFile& file_of(H5FD_t* base)
{
    return *reinterpret_cast<DriverFile*>(base);
}
const DriverFile& file_of(const H5FD_t* base)
{
    return *reinterpret_cast<const DriverFile*>(base);
}

void remember(DriverFile& file, int error)
{
    if (file.status->error == 0) file.status->error = error;
}

H5FD_t* open_file(const char* name, unsigned flags, hid_t access, haddr_t)
{
    const auto* info = static_cast<const Access*>(H5Pget_driver_info(access));
    if (info == nullptr || (flags & H5F_ACC_CREAT) == 0) return nullptr; // a driver for writing new files only
    const int descriptor = ::open(name, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0) {
        info->status->error = errno;
        return nullptr;
    }
    auto* file = new (std::nothrow) DriverFile{};
    if (file == nullptr) {
        ::close(descriptor);
        return nullptr;
    }
    file->descriptor = descriptor;
    file->status = info->status;
    return &file->base;
}

herr_t close_file(H5FD_t* base)
{
    DriverFile& file = file_of(base);
    if (::close(file.descriptor) != 0) remember(file, errno);
    delete &file;
    return 0;
}

/// Files of this driver are always new, so two handles are never the same file.
int compare(const H5FD_t* a, const H5FD_t* b)
{
    return a < b ? -1 : (a > b ? 1 : 0);
}

herr_t query(const H5FD_t*, unsigned long* flags)
{
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA;
    return 0;
}

haddr_t end_allocated(const H5FD_t* base, H5FD_mem_t)
{
    return file_of(base).end_allocated;
}

herr_t set_end_allocated(H5FD_t* base, H5FD_mem_t, haddr_t end)
{
    file_of(base).end_allocated = end;
    return 0;
}

haddr_t end_written(const H5FD_t* base, H5FD_mem_t)
{
    return file_of(base).end_written;
}

herr_t read_bytes(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, void* buffer)
{
    DriverFile& file = file_of(base);
    auto* to = static_cast<char*>(buffer);
    while (size > 0) {
        const ssize_t count = ::pread(file.descriptor, to, size, static_cast<off_t>(address));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return -1;
        if (count == 0) {
            std::memset(to, 0, size); // beyond the end, as the library expects
            return 0;
        }
        to += count;
        size -= static_cast<std::size_t>(count);
        address += static_cast<haddr_t>(count);
    }
    return 0;
}

herr_t write_bytes(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, const void* buffer)
{
    DriverFile& file = file_of(base);
    const auto* from = static_cast<const char*>(buffer);
    file.end_written = std::max(file.end_written, address + size);
    while (size > 0 && file.status->error == 0) {
        const ssize_t count = ::pwrite(file.descriptor, from, size, static_cast<off_t>(address));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) {
            remember(file, errno);
            break;
        }
        from += count;
        size -= static_cast<std::size_t>(count);
        address += static_cast<haddr_t>(count);
    }
    return 0;
}

herr_t truncate_file(H5FD_t* base, hid_t, hbool_t)
{
    DriverFile& file = file_of(base);
    if (file.end_allocated == file.end_written) return 0;
    if (file.status->error == 0 && ::ftruncate(file.descriptor, static_cast<off_t>(file.end_allocated)) != 0)
        remember(file, errno);
    file.end_written = file.end_allocated;
    return 0;
}

hid_t register_driver()
{
    static H5FD_class_t driver{};
    driver.name = "remember_errors";
    driver.maxaddr = (haddr_t(1) << 62) - 1;
    driver.fc_degree = H5F_CLOSE_STRONG;
    driver.fapl_size = sizeof(Access);
    driver.open = open_file;
    driver.close = close_file;
    driver.cmp = compare;
    driver.query = query;
    driver.get_eoa = end_allocated;
    driver.set_eoa = set_end_allocated;
    driver.get_eof = end_written;
    driver.read = read_bytes;
    driver.write = write_bytes;
    driver.truncate = truncate_file;
    for (H5FD_mem_t& kind : driver.fl_map) kind = H5FD_MEM_SUPER; // one free list for all kinds of memory
    return H5FDregister(&driver);
}
} // namespace

std::int64_t make_write_access(WriteStatus& status)
{
    static const hid_t driver = register_driver();
    const hid_t list = H5Pcreate(H5P_FILE_ACCESS);
    const Access access{&status};
    if (list >= 0 && H5Pset_driver(list, driver, &access) < 0) {
        H5Pclose(list);
        return -1;
    }
    return list;
}
} // namespace io
