#include "io/process_memory.h"

#include <cstdlib> // defines __GLIBC__
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <fstream>
#include <sys/resource.h>
#include <unistd.h>

namespace io
{
std::uint64_t resident_bytes()
{
    std::uint64_t total = 0, resident = 0; // pages
    std::ifstream("/proc/self/statm") >> total >> resident;
    return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::uint64_t peak_resident_bytes()
{
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024; // Linux counts in kB
}

std::uint64_t machine_bytes()
{
    return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void return_free_memory()
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}
} // namespace io
