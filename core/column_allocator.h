/// Memory of long columns that a kernel walks side by side.
///
/// A large block of the standard allocator begins 16 bytes behind a page: every 64-byte access to it crosses a cache
/// line, and the same element of all columns falls into the same set of the nearest cache, which holds fewer lines than
/// a step reads columns. Here a column begins on a cache line, and each allocation begins three lines further into its
/// page than the one before.
#pragma once

#include <atomic>
#include <cstddef>
#include <new>

namespace core
{
namespace detail
{
inline constexpr std::size_t line_bytes = 64, page_bytes = 4096;

/// Lines between the begin of a page and that of the next column: 0, 3, 6, ... around the 64 lines of a page.
inline std::size_t next_shift()
{
    static std::atomic<std::size_t> count{0};
    return count.fetch_add(1, std::memory_order_relaxed) * 3 % (page_bytes / line_bytes);
}
} // namespace detail

/// Allocator of std::vector for such columns. Where a block lies never changes a result.
template <class T>
struct ColumnAllocator
{
    using value_type = T;

    ColumnAllocator() = default;
    template <class U>
    ColumnAllocator(const ColumnAllocator<U>&)
    {}

    T* allocate(std::size_t count)
    {
        using namespace detail;
        const std::size_t shift = line_bytes * (1 + next_shift()); // the first line keeps where the block began
        auto* const block = static_cast<std::byte*>(
            ::operator new(count * sizeof(T) + page_bytes + line_bytes, std::align_val_t(page_bytes)));
        new (block + shift - sizeof(std::byte*)) std::byte*(block);
        return reinterpret_cast<T*>(block + shift);
    }
    void deallocate(T* column, std::size_t)
    {
        std::byte* const block = *(reinterpret_cast<std::byte**>(column) - 1);
        ::operator delete(block, std::align_val_t(detail::page_bytes));
    }

    friend bool operator==(const ColumnAllocator&, const ColumnAllocator&) { return true; }
};
} // namespace core
