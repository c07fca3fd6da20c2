// Counting bits, on host and device.
#pragma once

#include <bit>
#include <cstdint>

#include "lattice/host_device.hpp"

namespace meniscus {

MENISCUS_HD inline int popcount(std::uint64_t bits) {
#ifdef __CUDA_ARCH__
    return __popcll(bits);
#else
    return std::popcount(bits);
#endif
}

/// Index of the lowest bit that is set; bits != 0.
MENISCUS_HD inline int lowest_bit(std::uint64_t bits) {
#ifdef __CUDA_ARCH__
    return __ffsll(static_cast<long long>(bits)) - 1;
#else
    return std::countr_zero(bits);
#endif
}

}  // namespace meniscus
