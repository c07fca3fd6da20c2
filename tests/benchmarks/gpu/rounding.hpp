// Roots, quotients and fused sums as the device computes them, for arguments that host and device find by themselves.
#pragma once

#include <cstdint>
#include <cstring>

#include "engine/cuda/launch.hpp"
#include "lattice/host_device.hpp"

namespace meniscus::benchmarks {

enum class Operation : std::uint8_t { root, reciprocal, quotient, fused };

/// Three arguments, of which an operation takes as many as it needs.
struct Arguments {
    float a, b, c;
};

/// Bits of all kinds alike (SplitMix64), thus numbers of every exponent, infinities and denormal numbers among them.
MENISCUS_HD inline std::uint64_t random_bits(std::uint64_t i) {
    std::uint64_t bits = (i + 1) * 0x9E37'79B9'7F4A'7C15U;
    bits = (bits ^ (bits >> 30)) * 0xBF58'476D'1CE4'E5B9U;
    bits = (bits ^ (bits >> 27)) * 0x94D0'49BB'1331'11EBU;
    return bits ^ (bits >> 31);
}

/// The i-th of `count`: for one argument they are spread over all bit patterns, and are all of them at 2^32.
MENISCUS_HD inline Arguments arguments(Operation operation, std::uint64_t i, std::uint64_t count) {
    const auto as_float = [](std::uint32_t bits) {
        float value = 0.0F;
        memcpy(&value, &bits, sizeof(value));
        return value;
    };
    if (operation == Operation::root || operation == Operation::reciprocal)
        return {as_float(static_cast<std::uint32_t>(i * ((std::uint64_t{1} << 32) / count))), 0.0F, 0.0F};
    const std::uint64_t first = random_bits(2 * i);
    return {as_float(static_cast<std::uint32_t>(first)), as_float(static_cast<std::uint32_t>(first >> 32)),
            as_float(static_cast<std::uint32_t>(random_bits(2 * i + 1)))};
}

/// The results for arguments `first` to `first + n` of `count`, into out[n] on the device.
void compute_on_device(Operation operation, std::uint64_t first, std::uint64_t n, std::uint64_t count, float* out,
                       const cuda::Launcher& launch);

}  // namespace meniscus::benchmarks
