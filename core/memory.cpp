// Accounts of memory, and aligned allocation.
#include "meniscus/memory.hpp"

#include <sys/mman.h>

#include <cstdlib>
#include <string>

#include "meniscus/error.hpp"

namespace meniscus {

void MemoryAccount::charge(std::size_t bytes) {
    const std::size_t now = bytes_.fetch_add(bytes, std::memory_order_relaxed) + bytes;
    if (limit_ != 0 && now > limit_) {
        bytes_.fetch_sub(bytes, std::memory_order_relaxed);
        throw LimitExceeded("the reconstruction would hold " + std::to_string(now) + " bytes " + place_ +
                            ", more than its limit of " + std::to_string(limit_) +
                            ": use a larger cell size, fewer particles or a higher memory limit");
    }
    allocations_.fetch_add(1, std::memory_order_relaxed);
    std::size_t peak = peak_.load(std::memory_order_relaxed);
    while (now > peak && !peak_.compare_exchange_weak(peak, now, std::memory_order_relaxed)) {
    }
}

void MemoryAccount::release(std::size_t bytes) noexcept {
    bytes_.fetch_sub(bytes, std::memory_order_relaxed);
}

void* allocate_aligned(std::size_t bytes) noexcept {
    constexpr std::size_t line = 64, page = std::size_t{2} << 20;
    const std::size_t alignment = bytes < 2 * page ? line : page;
    void* const memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    // Large arrays are read in the order of blocks, which jumps: huge pages spare them the misses in the page tables.
    // Advice only: where the kernel has none, nothing is lost. Whole pages alone, since the tail's may never be
    // touched.
    if (memory != nullptr && alignment == page) madvise(memory, bytes / page * page, MADV_HUGEPAGE);
    return memory;
}

void free_aligned(void* memory) noexcept {
    std::free(memory);
}

}  // namespace meniscus
