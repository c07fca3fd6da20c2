// A request to a reconstruction under way: to end early.
#pragma once

#include <atomic>
#include <cstdint>

namespace meniscus {

/// Raised by any thread; read by the loops of the CPU between pieces of work, and by the kernels of a GPU, into whose
/// addresses this page of the host's memory is mapped. A reconstruction whose flag is raised ends with Stopped within
/// 0.2 s; one that begins while it is raised ends at once.
class StopFlag {
public:
    StopFlag() = default;
    StopFlag(const StopFlag&) = delete;
    StopFlag& operator=(const StopFlag&) = delete;

    void raise() noexcept { raised_.store(1, std::memory_order_relaxed); }
    /// Lowers the flag, for the next reconstruction.
    void lower() noexcept { raised_.store(0, std::memory_order_relaxed); }
    bool is_raised() const noexcept { return raised_.load(std::memory_order_relaxed) != 0; }

    /// The word that kernels read: not 0 where the flag is raised.
    const std::atomic<std::uint32_t>* word() const noexcept { return &raised_; }

    static constexpr std::size_t page_bytes = 4096;  ///< CUDA maps whole pages

private:
    alignas(page_bytes) std::atomic<std::uint32_t> raised_{0};
};

}  // namespace meniscus
