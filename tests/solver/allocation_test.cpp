/// What a step allocates once it is warm: calls of operator new on any thread. (Tasks of the thread pool come from its
/// own memory and do not count.)
#include "solver/stable_time_step.h"
#include "tests/support/runs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace
{
std::atomic<bool> counting = false;
std::atomic<int> allocations = 0;

void* allocate(std::size_t size, std::size_t alignment)
{
    if (counting) ++allocations;
    void* memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}
} // namespace

// The program's one set of replacements; all other forms of new and delete end here. (Those that do not throw would by
// themselves, but not beside a sanitizer's.)
void* operator new(std::size_t size)
{
    return allocate(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment)
{
    return allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept
{
    try {
        return operator new(size);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}
void operator delete(void* memory) noexcept
{
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept
{
    std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept
{
    std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept
{
    std::free(memory);
}

namespace
{
/// A bar of two levels under load; its material may separate but does not.
support::Job bar(const solver::Numerics& numerics)
{
    material::Material metal = support::metal();
    metal.plastic = material::VonMises{10, 100};
    metal.decohesion = material::Decohesion{};
    metal.decohesion->s_max = metal.decohesion->tau_max = 1000;
    metal.decohesion->u0 = 2e-3;
    solver::Problem problem = support::bar(metal, 5, 0.01);
    problem.grid.levels = 2;
    problem.zones = {support::zone(geometry::box({-1, 1, -1}, {3, 2, 3}), 1)};
    problem.numerics = numerics;
    return support::started(problem);
}

int allocations_of(int steps, support::Job& run)
{
    allocations = 0;
    counting = true;
    support::advance(steps, run);
    counting = false;
    return allocations;
}

constexpr int interval = solver::time_step_interval;
} // namespace

TEST(Allocation, is_seen_by_the_counter)
{
    allocations = 0;
    counting = true;
    std::vector<Real>(7).swap(*std::make_unique<std::vector<Real>>());
    std::vector<grid::NodeSum>(3).clear(); // over-aligned
    counting = false;
    EXPECT_EQ(allocations, 3);
}

// Whatever the size of the body: only the choice of dt makes tables, one value per leaf.
TEST(Allocation, a_step_of_the_nodal_scheme_makes_none)
{
    for (const solver::Precision precision : {solver::Precision::f64, solver::Precision::mixed}) {
        support::Job run = bar(support::nodal_numerics(precision));
        support::advance(2 * interval, run);
        EXPECT_LE(allocations_of(1, run), 2); // chooses dt
        EXPECT_EQ(allocations_of(interval - 1, run), 0);
        EXPECT_LE(allocations_of(interval, run), 2);
    }
}

TEST(Allocation, a_subcycled_step_makes_none)
{
    support::Job run = bar(support::subcycled_numerics(solver::Precision::mixed));
    const int between = interval / solver::substeps(run.problem);
    support::advance(2 * between, run);
    EXPECT_LE(allocations_of(1, run), 2); // chooses dt
    EXPECT_EQ(allocations_of(between - 1, run), 0);
}

// One table of what the leaves' tasks collect per step.
TEST(Allocation, a_step_of_the_total_formulation_makes_one)
{
    support::Job run = bar(support::numerics(solver::Formulation::total));
    support::advance(2 * interval, run);
    EXPECT_LE(allocations_of(1, run), 2); // chooses dt
    EXPECT_EQ(allocations_of(interval - 1, run), interval - 1);
}
