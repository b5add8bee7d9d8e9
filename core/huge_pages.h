/// Large arrays that every step streams, on huge pages where the system gives them: with pages of 4 kB a body of some
/// million particles misses the address cache on every block, and on a virtual machine a miss costs twice.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace core
{
/// Room for `count` elements. The wish has to come before the first touch, so: reserve, ask, then fill.
template <class T>
void reserve_huge_pages(std::size_t count, std::vector<T>& values)
{
    if (count <= values.capacity()) return;
    values.reserve(count);
    constexpr std::uintptr_t page = std::uintptr_t{1} << 21; // byte, x86-64
    const auto begin = reinterpret_cast<std::uintptr_t>(values.data());
    const std::uintptr_t first = (begin + page - 1) / page * page;
    const std::uintptr_t last = (begin + count * sizeof(T)) / page * page;
    if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE); // refused: small pages
}
} // namespace core
