// Checks what a simulator sends and puts its frames together: the edge at which the wire's claims are verified.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "meniscus/settings.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/intake/frame_plan.hpp"
#include "sessions/intake/input_frame.hpp"
#include "sessions/limits/limits.hpp"

namespace meniscus::server {

/// Throws InvalidInput for messages that are out of order or out of range, LimitExceeded for a frame past a limit:
/// before it allocates what the message asks for.
class FrameAssembler {
public:
    /// settings: of the session; they name the arrays that are kept.
    explicit FrameAssembler(const Limits& limits, const Settings& settings = {})
        : limits_(limits), settings_(settings) {}

    void begin(const v1::FrameBegin& message, InputFrame& frame);
    void append(const v1::FrameChunk& message, InputFrame& frame);
    /// A chunk of this many bytes. source.copy_to(std::span<std::byte>) takes its next ones, source.skip(std::size_t)
    /// passes over them.
    template <class Source>
    void append(std::size_t bytes, InputFrame& frame, Source& source) {
        admit_chunk(bytes, frame);
        while (bytes > 0) {
            const FramePlan::Piece& piece = plan_.pieces[piece_];
            const std::size_t part = std::min(bytes, piece.end - filled_);
            if (piece.kept) {
                const std::size_t place = piece.place + (filled_ - piece.begin);
                source.copy_to(std::span(frame.bytes).subspan(place, part));
                kept_ += part;
            } else {
                source.skip(part);
            }
            filled_ += part;
            bytes -= part;
            if (filled_ == piece.end) ++piece_;
        }
    }
    void end(InputFrame& frame);
    /// No further message follows.
    void end_of_stream() const;

    bool in_frame() const noexcept { return in_frame_; }
    /// Bytes of the frame begun last that are announced, those of arrays that are passed over included.
    std::size_t expected() const noexcept { return expected_; }
    /// Bytes of InputFrame::bytes that it takes by what has arrived.
    std::size_t arrived() const noexcept { return filled_ == expected_ ? plan_.bytes : kept_; }

private:
    /// Throws LimitExceeded for a frame past a limit, InvalidInput as arrays_to_keep().
    FramePlan plan(const v1::FrameBegin& message, const conversion::ParticleLayout& layout) const;
    /// Throws for one that is out of place, or too many.
    void admit_chunk(std::size_t bytes, const InputFrame& frame);

    Limits limits_;
    Settings settings_;
    bool in_frame_ = false;
    FramePlan plan_;          ///< of the frame begun last
    std::size_t piece_ = 0;   ///< that the next byte is of
    std::size_t filled_ = 0;  ///< bytes that have arrived
    std::size_t kept_ = 0;    ///< of those
    std::uint32_t chunks_ = 0;
    std::optional<std::uint64_t> index_;  ///< of the frame begun last
    std::size_t expected_ = 0;
};

}  // namespace meniscus::server
