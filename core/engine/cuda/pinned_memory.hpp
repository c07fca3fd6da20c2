// Host memory that the device copies from and to while both go on.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

#include "engine/cuda/errors.hpp"
#include "meniscus/memory.hpp"

namespace meniscus::cuda {

/// Whether a lost device has left memory pinned that was freed since. To the other devices its addresses are pinned
/// still, whatever lies there now, and they would copy from pages that no longer belong to the process: from then on
/// nothing counts as pinned, and copies go through memory that CUDA itself has allocated.
inline std::atomic<bool> pages_are_lost{false};

/// Whether both ends of this memory of a caller's are pinned. What lies between need not be: the arrays beside it may
/// be pinned, and share its first and last pages.
inline bool is_pinned(const void* begin, std::size_t bytes) {
    const auto is_pinned_at = [](const std::byte* at) {
        cudaPointerAttributes attributes{};
        const cudaError_t status = cudaPointerGetAttributes(&attributes, at);
        if (status != cudaSuccess) cudaGetLastError();
        return status == cudaSuccess && attributes.type == cudaMemoryTypeHost;
    };
    const auto* const first = static_cast<const std::byte*>(begin);
    return !pages_are_lost && bytes != 0 && is_pinned_at(first) && is_pinned_at(first + (bytes - 1));
}

/// Begins a copy from or to memory of a caller's that the device makes by itself, while the host goes on. Returns
/// false, with nothing begun, where that memory is not pinned as a whole.
inline bool copy_straight(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind, cudaStream_t stream) {
    if (!is_pinned(kind == cudaMemcpyHostToDevice ? from : to, bytes)) return false;
    const cudaError_t status = cudaMemcpyAsync(to, from, bytes, kind, stream);
    // So CUDA refuses memory of which only a part is pinned.
    if (status == cudaErrorInvalidValue) {
        cudaGetLastError();
        return false;
    }
    check(status, "cudaMemcpyAsync");
    return true;
}

/// No copy from or to it may be under way when it grows or ends.
class PinnedMemory {
public:
    explicit PinnedMemory(std::shared_ptr<MemoryAccount> account) : account_(std::move(account)) {}
    ~PinnedMemory() { release(); }
    PinnedMemory(const PinnedMemory&) = delete;
    PinnedMemory& operator=(const PinnedMemory&) = delete;

    /// Grows with some room to spare; what was there is lost then.
    void reserve(std::size_t bytes) {
        if (bytes <= bytes_) return;
        release();
        const std::size_t room = bytes + bytes / 8;
        account_->charge(room);
        const cudaError_t status = cudaMallocHost(&memory_, room);
        if (status != cudaSuccess) {
            memory_ = nullptr;
            account_->release(room);
            check(status, "cudaMallocHost");
        }
        bytes_ = room;
    }
    std::byte* get() const { return static_cast<std::byte*>(memory_); }

private:
    void release() {
        if (memory_ == nullptr) return;
        cudaFreeHost(memory_);
        account_->release(bytes_);
        memory_ = nullptr;
        bytes_ = 0;
    }

    std::shared_ptr<MemoryAccount> account_;
    void* memory_ = nullptr;
    std::size_t bytes_ = 0;
};

}  // namespace meniscus::cuda
