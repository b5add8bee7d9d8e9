/// A HDF5 file driver that never fails a write: it remembers the first error and drops what follows.
///
/// HDF5 1.10 cannot close a file whose writes fail: H5Fclose returns an error, the file stays open inside the library,
/// and a later call crashes (seen with a full disk and with a file-size limit). With this driver the library always
/// closes cleanly, and the owner of the file asks the status whether the bytes are really there.
#pragma once

#include <cstdint>

namespace io
{
/// What the driver reports: errno of the first failed write, 0 if every byte was accepted.
struct WriteStatus
{
    int error = 0;
};

/// File-access property list of the driver; close it with H5Pclose.
/// @param status  must outlive the file
/// @return an hid_t, negative on failure
std::int64_t make_write_access(WriteStatus& status);
} // namespace io
