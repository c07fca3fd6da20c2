// Pages of the host's memory that the GPU may copy from and to by itself.
#include <atomic>
#include <exception>
#include <string>
#include <utility>

#include "engine/cuda/errors.hpp"
#include "engine/cuda/pinned_memory.hpp"
#include "meniscus/devices.hpp"

namespace meniscus::cuda {
namespace {

/// Registers memory that is there already rather than to allocate other memory: where CUDA refuses, nothing else
/// changes.
class RegisteredPages final : public PagePinning {
public:
    RegisteredPages(int device, std::function<void(const std::string& reason)> on_refusal)
        : device_(device), on_refusal_(std::move(on_refusal)) {}

    void pin(void* begin, std::size_t bytes) noexcept override {
        try {
            if (pages_are_lost) return refused("a GPU has been lost, with memory that was pinned for it");
            const CurrentDevice current(device_);
            const cudaError_t status = cudaHostRegister(begin, bytes, cudaHostRegisterPortable);
            if (status == cudaSuccess) return;
            cudaGetLastError();
            refused(cudaGetErrorString(status));
        } catch (const std::exception& error) {
            refused(error.what());  // the next frame meets the same refusal, and throws
        }
    }
    void unpin(void* begin) noexcept override {
        try {
            const CurrentDevice current(device_);
            const cudaError_t status = cudaHostUnregister(begin);
            cudaGetLastError();
            // The last two errors are those of memory that was refused: of no consequence.
            if (status == cudaSuccess || status == cudaErrorHostMemoryNotRegistered || status == cudaErrorInvalidValue)
                return;
        } catch (const std::exception&) {
            // The device is lost, as in the case below.
        }
        // The device is lost, and copies nothing any more; other devices would.
        pages_are_lost = true;
    }

private:
    void refused(const std::string& reason) {
        if (on_refusal_ && !reported_.exchange(true)) on_refusal_(reason);
    }

    const int device_;
    const std::function<void(const std::string& reason)> on_refusal_;
    std::atomic<bool> reported_{false};
};

}  // namespace

std::shared_ptr<PagePinning> page_pinning(int device, std::function<void(const std::string& reason)> on_refusal) {
    return std::make_shared<RegisteredPages>(device, std::move(on_refusal));
}

}  // namespace meniscus::cuda
