// A StopFlag where kernels can read it: its page of the host's memory, mapped into the device's addresses.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "engine/cuda/errors.hpp"
#include "meniscus/stop_flag.hpp"

namespace meniscus::cuda {

/// One flag is mapped for one reconstruction at a time. The current device is the same at begin and end.
class MappedStop {
public:
    /// flag: may be none.
    explicit MappedStop(std::shared_ptr<const StopFlag> flag) : flag_(std::move(flag)) {
        if (flag_ == nullptr) return;
        check(cudaHostRegister(page(), StopFlag::page_bytes, cudaHostRegisterMapped), "cudaHostRegister");
        void* mapped = nullptr;
        const cudaError_t status = cudaHostGetDevicePointer(&mapped, page(), 0);
        if (status != cudaSuccess) cudaHostUnregister(page());
        check(status, "cudaHostGetDevicePointer");
        word_ = static_cast<const volatile std::uint32_t*>(mapped);
    }
    ~MappedStop() {
        if (flag_ != nullptr) cudaHostUnregister(page());
    }
    MappedStop(const MappedStop&) = delete;
    MappedStop& operator=(const MappedStop&) = delete;

    bool is_raised() const { return flag_ != nullptr && flag_->is_raised(); }
    /// The word that kernels read: not 0 where the flag is raised. Null without a flag.
    const volatile std::uint32_t* word() const { return word_; }

private:
    void* page() const { return const_cast<std::atomic<std::uint32_t>*>(flag_->word()); }

    std::shared_ptr<const StopFlag> flag_;
    const volatile std::uint32_t* word_ = nullptr;
};

}  // namespace meniscus::cuda
