// A piece of device memory, allocated and freed in the order of its stream, charged to an account.
#pragma once

#include <cstddef>
#include <memory>

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

    /// Makes room for this many bytes, all zero; what was there is lost. Throws LimitExceeded before anything is
    /// allocated if the account would pass its limit.
    void assign(std::size_t bytes) {
        release();
        // Else the old piece would still be there, uncounted, beside the new one.
        check(cudaStreamSynchronize(stream_), "cudaStreamSynchronize");
        account_->charge(bytes);
        const cudaError_t status = cudaMallocFromPoolAsync(&memory_, bytes, pool_, stream_);
        if (status != cudaSuccess) {
            memory_ = nullptr;
            account_->release(bytes);
            check(status, "cudaMallocFromPoolAsync");
        }
        bytes_ = bytes;
        check(cudaMemsetAsync(memory_, 0, bytes, stream_), "cudaMemsetAsync");
    }
    void release() {
        if (memory_ == nullptr) return;
        cudaFreeAsync(memory_, stream_);
        account_->release(bytes_);
        memory_ = nullptr;
        bytes_ = 0;
    }
    std::byte* get() const { return static_cast<std::byte*>(memory_); }
    std::size_t bytes() const { return bytes_; }

private:
    cudaStream_t stream_;
    std::shared_ptr<MemoryAccount> account_;
    cudaMemPool_t pool_ = nullptr;
    void* memory_ = nullptr;
    std::size_t bytes_ = 0;
};

}  // namespace meniscus::cuda
