// Accounts of memory, and aligned allocation.
#include "meniscus/memory.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "meniscus/error.hpp"

namespace meniscus {

std::size_t SharedMemory::try_charge(std::size_t bytes) noexcept {
    std::size_t before = bytes_.load(std::memory_order_relaxed);
    do {
        if (limit_ == 0) continue;
        const std::size_t room = limit_ - std::min(limit_, before);
        if (bytes > room) return bytes - room;
    } while (!bytes_.compare_exchange_weak(before, before + bytes, std::memory_order_relaxed));
    return 0;
}

bool SharedMemory::charge(std::size_t bytes) {
    while (const std::size_t missing = try_charge(bytes)) {
        if (!make_room_ || bytes > limit_) return false;
        const std::size_t before = this->bytes();
        make_room_(missing);
        // Another thread may have taken the room; where none was made, there is none to be had.
        if (this->bytes() >= before) return try_charge(bytes) == 0;
    }
    return true;
}

void MemoryAccount::charge(std::size_t bytes) {
    const std::size_t now = bytes_.fetch_add(bytes, std::memory_order_relaxed) + bytes;
    const std::size_t limit = this->limit();
    if (limit != 0 && now > limit) {
        bytes_.fetch_sub(bytes, std::memory_order_relaxed);
        throw MemoryLimitExceeded("the reconstruction would hold " + std::to_string(now) + " bytes " + place_ +
                                  ", more than its limit of " + std::to_string(limit) +
                                  ": use a larger cell size, fewer particles or a higher memory limit");
    }
    if (shared_ && !shared_->charge(bytes)) {
        bytes_.fetch_sub(bytes, std::memory_order_relaxed);
        throw MemoryLimitExceeded(
            "the reconstruction would hold " + std::to_string(now) + " bytes " + place_ +
            ", and all together more than their limit of " + std::to_string(shared_->limit()) +
            ": try again later, or use a larger cell size, fewer particles or a higher memory limit");
    }
    allocations_.fetch_add(1, std::memory_order_relaxed);
    std::size_t peak = peak_.load(std::memory_order_relaxed);
    while (now > peak && !peak_.compare_exchange_weak(peak, now, std::memory_order_relaxed)) {
    }
}

void MemoryAccount::release(std::size_t bytes) noexcept {
    bytes_.fetch_sub(bytes, std::memory_order_relaxed);
    if (shared_) shared_->release(bytes);
}

void* allocate_aligned(std::size_t bytes) noexcept {
    constexpr std::size_t line = 64, small_page = 4096, page = std::size_t{2} << 20;
    const std::size_t least_alignment = bytes < PagePinning::least_bytes ? line : small_page;
    const std::size_t alignment = bytes < 2 * page ? least_alignment : page;
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
