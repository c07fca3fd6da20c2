// Checks what a simulator sends and puts its frames together: the edge at which the wire's claims are verified.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "meniscus/v1/surface_service.pb.h"
#include "sessions/input_frame.hpp"
#include "sessions/limits/limits.hpp"

namespace meniscus::server {

/// Throws InvalidInput for messages that are out of order or out of range, LimitExceeded for a frame past a limit:
/// before it allocates what the message asks for.
class FrameAssembler {
public:
    explicit FrameAssembler(const Limits& limits) : limits_(limits) {}

    void begin(const v1::FrameBegin& message, InputFrame& frame);
    void append(const v1::FrameChunk& message, InputFrame& frame);
    /// The place for a chunk of this many bytes.
    std::span<std::byte> append(std::size_t bytes, InputFrame& frame);
    void end(InputFrame& frame);
    /// No further message follows.
    void end_of_stream() const;

    bool in_frame() const noexcept { return in_frame_; }
    /// Bytes of the frame begun last: announced, and arrived.
    std::size_t expected() const noexcept { return expected_; }
    std::size_t arrived() const noexcept { return filled_; }

private:
    /// Of the whole frame. Throws LimitExceeded.
    std::size_t admitted_bytes(const v1::FrameBegin& message, std::uint64_t particle_bytes) const;

    Limits limits_;
    bool in_frame_ = false;
    std::size_t filled_ = 0;
    std::uint32_t chunks_ = 0;
    std::optional<std::uint64_t> index_;  ///< of the frame begun last
    std::size_t expected_ = 0;
};

}  // namespace meniscus::server
