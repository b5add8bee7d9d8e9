/// Memory of this process as the operating system sees it.
#pragma once

#include <cstdint>

namespace io
{
/// Resident memory now [byte]; 0 if the system does not tell.
std::uint64_t resident_bytes();
/// Largest resident memory since the start of the process [byte].
std::uint64_t peak_resident_bytes();

/// Memory of the machine [byte].
std::uint64_t machine_bytes();

/// Give memory that was freed inside the allocator's heap back to the system: after the beginning of a run and after
/// output, which leave large holes.
void return_free_memory();
} // namespace io
