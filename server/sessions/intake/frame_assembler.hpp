// Checks what a stream sends and puts the bytes of frames in their places: the edge at which the wire's claims are
// verified.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

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

    /// A frame, or the stream's part of one, that is to begin. place() or pass_over() follows, before the first chunk.
    FramePart announce(const v1::FrameBegin& message) const;
    FramePart announce(const v1::PublishBegin& message) const;
    /// Begins it. pieces: see begin_frame().
    void place(const FramePart& part, std::vector<FramePiece> pieces);
    /// Begins it, and keeps none of its bytes.
    void pass_over(const FramePart& part);
    void append(const v1::FrameChunk& message, InputFrame& frame);
    /// A chunk of this many bytes. source.copy_to(std::span<std::byte>) takes its next ones, source.skip(std::size_t)
    /// passes over them.
    template <class Source>
    void append(std::size_t bytes, InputFrame& frame, Source& source) {
        admit_chunk(bytes);
        while (bytes > 0) {
            const FramePiece& piece = pieces_[piece_];
            const std::size_t part = std::min(bytes, piece.end - filled_);
            if (piece.kept) {
                const std::size_t place = piece.place + (filled_ - piece.begin);
                source.copy_to(std::span(frame.bytes).subspan(place, part));
                kept_since_ += part;
            } else {
                source.skip(part);
            }
            filled_ += part;
            bytes -= part;
            if (filled_ == piece.end) ++piece_;
        }
    }
    void end();
    /// No further message follows.
    void end_of_stream() const;

    bool in_frame() const noexcept { return in_frame_; }
    /// Bytes of the frame begun last that are announced, those of arrays that are passed over included.
    std::size_t expected() const noexcept { return expected_; }
    /// Bytes that were put in their places since this was asked last.
    std::size_t take_kept() noexcept { return std::exchange(kept_since_, 0); }

private:
    /// Throws for an index that is out of order, and for a time that is none.
    FramePart announce(std::uint64_t index, double simulation_time) const;
    /// Throws for one that is out of place, or too many.
    void admit_chunk(std::size_t bytes);

    Limits limits_;
    Settings settings_;
    bool in_frame_ = false;
    std::vector<FramePiece> pieces_;  ///< of the frame begun last
    std::size_t piece_ = 0;           ///< that the next byte is of
    std::size_t filled_ = 0;          ///< bytes that have arrived
    std::size_t kept_since_ = 0;      ///< of those, since take_kept()
    std::string content_;             ///< of the frame begun last, in words: "7 particles"
    std::uint32_t chunks_ = 0;
    std::optional<std::uint64_t> index_;  ///< of the frame begun last
    std::size_t expected_ = 0;
};

}  // namespace meniscus::server
