// One particle frame as received, in a buffer that is reused.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "meniscus/memory.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus::server {

struct InputFrame {
    explicit InputFrame(const std::shared_ptr<MemoryAccount>& account) : bytes(AccountAllocator<std::byte>(account)) {}

    /// Makes `bytes` of this size; keeps its memory if that suffices. Throws LimitExceeded or std::bad_alloc.
    void allocate(std::size_t size);
    /// The particles, in place.
    ParticleFrame view() const;

    std::uint64_t index = 0;
    double simulation_time = 0.0;
    std::size_t particle_count = 0;
    bool quantized = false;
    bool has_levels = false;
    Box quantization_box;
    Array<std::byte> bytes;  ///< all positions, then all levels
    std::chrono::steady_clock::time_point received_at;
};

}  // namespace meniscus::server
