// Pieces of device memory, allocated and freed together in the order of their stream, charged to an account.
#pragma once

#include <cstddef>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include "engine/cuda/stream.hpp"
#include "meniscus/memory.hpp"

namespace meniscus::cuda {

class DeviceMemory {
public:
    DeviceMemory(int device, cudaStream_t stream, std::shared_ptr<MemoryAccount> account)
        : stream_(stream), account_(std::move(account)) {
        // A pool of its own gives freed memory back to the device at the next synchronization.
        cudaMemPoolProps properties{};
        properties.allocType = cudaMemAllocationTypePinned;
        properties.location.type = cudaMemLocationTypeDevice;
        properties.location.id = device;
        check(cudaMemPoolCreate(&pool_, &properties), "cudaMemPoolCreate");
    }
    ~DeviceMemory() {
        release();
        cudaMemPoolDestroy(pool_);
    }
    DeviceMemory(const DeviceMemory&) = delete;
    DeviceMemory& operator=(const DeviceMemory&) = delete;

    /// Makes room for pieces of these many bytes; what was there is lost. Throws LimitExceeded before anything is
    /// allocated if the account would pass its limit.
    void assign(std::span<const std::size_t> sizes) {
        release();
        // Else the old pieces would still be there, uncounted, beside the new ones.
        check(cudaStreamSynchronize(stream_), "cudaStreamSynchronize");
        const std::size_t bytes = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
        pieces_.reserve(sizes.size());
        account_->charge(bytes);
        bytes_ = bytes;
        for (const std::size_t size : sizes) {
            void* piece = nullptr;
            const cudaError_t status = cudaMallocFromPoolAsync(&piece, size, pool_, stream_);
            if (status != cudaSuccess) release();
            check(status, "cudaMallocFromPoolAsync");
            pieces_.push_back(static_cast<std::byte*>(piece));
        }
    }
    /// The same for one piece, all zero.
    void assign(std::size_t bytes) {
        assign(std::span(&bytes, 1));
        check(cudaMemsetAsync(get(), 0, bytes, stream_), "cudaMemsetAsync");
    }
    void release() {
        for (std::byte* const piece : pieces_) cudaFreeAsync(piece, stream_);
        pieces_.clear();
        account_->release(bytes_);
        bytes_ = 0;
    }
    std::byte* get(std::size_t piece = 0) const { return pieces_.empty() ? nullptr : pieces_[piece]; }
    /// Bytes of all pieces.
    std::size_t bytes() const { return bytes_; }

private:
    cudaStream_t stream_;
    std::shared_ptr<MemoryAccount> account_;
    cudaMemPool_t pool_ = nullptr;
    std::vector<std::byte*> pieces_;
    std::size_t bytes_ = 0;
};

}  // namespace meniscus::cuda
