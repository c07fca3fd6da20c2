// Faults that the software device's copies of core's sources have (faults.cmake): none is in force but the one that a
// test chooses. Shipped sources know nothing of them.
#pragma once

#include <cstdint>

namespace emulated_device {

enum class Fault : std::uint8_t {
    none,
    index_off_by_one,
    missing_barrier,
    early_stop,
    wrong_mask,
    unset_word,
    guard_overrun,
    missing_wait,
    wrong_block_count,
    lost_flag,
    unstable_order,
    scratch_too_small,
};

/// The fault in force.
inline Fault fault = Fault::none;

/// Puts a fault in force for the time of its life.
class FaultInForce {
public:
    explicit FaultInForce(Fault chosen) { fault = chosen; }
    ~FaultInForce() { fault = Fault::none; }
    FaultInForce(const FaultInForce&) = delete;
    FaultInForce& operator=(const FaultInForce&) = delete;
};

}  // namespace emulated_device
