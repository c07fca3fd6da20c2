// For programs that measure: sees every kernel, every call of CUB and every graph that one thread of the host puts on a
// stream. Without an observer a launch costs one comparison more.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/cuda/errors.hpp"

namespace meniscus::cuda {

enum class LaunchKind : std::uint8_t { kernel, sum, sort, graph };

/// One launch. A sum or a sort is a call of CUB as a whole, not its kernels.
struct Launch {
    LaunchKind kind = LaunchKind::kernel;
    cudaStream_t stream = nullptr;
    const void* kernel = nullptr;
    unsigned blocks = 0;
    bool is_cooperative = false;
    std::uint64_t elements = 0;     ///< number of elements of a sum or a sort
    std::size_t element_bytes = 0;  ///< size of a summand, or of a key with its value
    unsigned key_bits = 0;          ///< number of bits by which a sort orders
};

class LaunchObserver {
public:
    virtual void before(const Launch& launch) = 0;
    virtual void after(const Launch& launch) noexcept = 0;  ///< called also for a launch that has failed

protected:
    ~LaunchObserver() = default;
};

/// The observer of this thread.
inline constinit thread_local LaunchObserver* launch_observer = nullptr;

/// Reports a launch; lives around the calls that put it on its stream.
class ObservedLaunch {
public:
    explicit ObservedLaunch(const Launch& launch) : launch_(launch) {
        if (launch_observer != nullptr) launch_observer->before(launch_);
    }
    ~ObservedLaunch() {
        if (launch_observer != nullptr) launch_observer->after(launch_);
    }
    ObservedLaunch(const ObservedLaunch&) = delete;
    ObservedLaunch& operator=(const ObservedLaunch&) = delete;

private:
    Launch launch_;
};

}  // namespace meniscus::cuda
