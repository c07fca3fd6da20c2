// One particle frame as received, in a buffer that is reused.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "meniscus/memory.hpp"
#include "meniscus/particle_frame.hpp"
#include "sessions/limits/bytes_in_flight.hpp"

namespace meniscus::server {

struct InputFrame {
    explicit InputFrame(const std::shared_ptr<MemoryAccount>& account,
                        std::shared_ptr<BytesInFlight> all_sessions = std::make_shared<BytesInFlight>())
        : bytes(AccountAllocator<std::byte>(account)), in_flight_(std::move(all_sessions)) {}

    /// Makes `bytes` of this size, which are then in flight; keeps its memory if that suffices. Throws LimitExceeded or
    /// std::bad_alloc.
    void allocate(std::size_t size);
    /// Its bytes are no longer in flight. Its memory stays for the next frame.
    void land() noexcept { in_flight_.release(); }
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
    /// Of the run, once the session has shown these particles; none again from allocate() on.
    std::optional<std::uint64_t> shown_in_run;

private:
    ShareInFlight in_flight_;
};

}  // namespace meniscus::server
