#include "sessions/intake/frame_assembler.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <utility>

#include "conversion/particle_arrays.hpp"
#include "conversion/settings_conversion.hpp"
#include "meniscus/error.hpp"
#include "meniscus/frame_order.hpp"

namespace meniscus::server {

namespace {

Box quantization_box(const v1::FrameBegin& message) {
    if (!message.has_quantization_box())
        throw InvalidInput(fmt::format("frame {}: positions of uint16 need a quantization_box", message.frame_index()));
    const Box box = conversion::from_wire(message.quantization_box(), "quantization_box");
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const char name = "xyz"[axis];
        const double min = box.min[axis];
        const double max = box.max[axis];
        if (!std::isfinite(min) || !std::isfinite(max))
            throw InvalidInput(
                fmt::format("frame {}: quantization_box runs from {} to {} on the {} axis; it must be finite",
                            message.frame_index(), min, max, name));
        if (min > max)
            throw InvalidInput(
                fmt::format("frame {}: quantization_box runs from {} to {} on the {} axis; max must not be below min",
                            message.frame_index(), min, max, name));
    }
    return box;
}

/// The bytes of a FrameChunk, taken piece by piece.
class ChunkSource {
public:
    explicit ChunkSource(const v1::FrameChunk& chunk) : left_(std::as_bytes(std::span(chunk.data()))) {}
    void copy_to(std::span<std::byte> place) {
        std::memcpy(place.data(), left_.data(), place.size());
        skip(place.size());
    }
    void skip(std::size_t bytes) { left_ = left_.subspan(bytes); }

private:
    std::span<const std::byte> left_;
};

}  // namespace

FramePart FrameAssembler::announce(std::uint64_t index, double simulation_time) const {
    if (in_frame_) throw InvalidInput(fmt::format("frame {} begins before frame {} has ended", index, *index_));
    require_frame_order(index_, index, simulation_time);
    FramePart part;
    part.index = index;
    part.simulation_time = simulation_time;
    return part;
}

FramePart FrameAssembler::announce(const v1::PublishBegin& message) const {
    FramePart part = announce(message.mesh().frame_index(), message.mesh().simulation_time());
    try {
        part.bricks = brick_part(message, settings_);
    } catch (const InvalidInput& error) {
        throw InvalidInput(fmt::format("frame {}: {}", part.index, error.what()));
    }
    return part;
}

FramePart FrameAssembler::announce(const v1::FrameBegin& message) const {
    FramePart part = announce(message.frame_index(), message.simulation_time());
    part.particle_count = message.particle_count();
    try {
        part.layout = conversion::particle_layout(message.arrays());
        part.kept = arrays_to_keep(part.layout, part.particle_count, settings_);
    } catch (const InvalidInput& error) {
        throw InvalidInput(fmt::format("frame {}: {}", message.frame_index(), error.what()));
    }
    if (part.layout.quantized) part.quantization_box = quantization_box(message);
    return part;
}

void FrameAssembler::place(const FramePart& part, std::vector<FramePiece> pieces) {
    pieces_ = std::move(pieces);
    expected_ = arriving_bytes(part);
    content_ =
        part.bricks ? fmt::format("{} bricks", part.bricks->bricks) : fmt::format("{} particles", part.particle_count);
    index_ = part.index;
    piece_ = 0;
    filled_ = 0;
    kept_since_ = 0;
    chunks_ = 0;
    in_frame_ = true;
}

void FrameAssembler::pass_over(const FramePart& part) {
    place(part, {{.begin = 0, .end = arriving_bytes(part)}});
}

void FrameAssembler::append(const v1::FrameChunk& message, InputFrame& frame) {
    ChunkSource source(message);
    append(message.data().size(), frame, source);
}

void FrameAssembler::admit_chunk(std::size_t bytes) {
    if (!in_frame_) throw InvalidInput("a chunk outside of a frame; frame_begin comes first");
    if (bytes > chunk_bytes)
        throw InvalidInput(
            fmt::format("frame {}: a chunk of {} bytes; at most {} are allowed", *index_, bytes, chunk_bytes));
    if (limits_.chunks_per_frame != 0 && chunks_ >= limits_.chunks_per_frame)
        throw LimitExceeded(
            fmt::format("frame {}: more than {} chunks; the server takes at most {} per frame: send larger ones",
                        *index_, chunks_, limits_.chunks_per_frame));
    if (bytes > expected_ - filled_)
        throw InvalidInput(fmt::format("frame {}: at least {} bytes for {}; {} were announced", *index_,
                                       filled_ + bytes, content_, expected_));
    ++chunks_;
}

void FrameAssembler::end() {
    if (!in_frame_) throw InvalidInput("frame_end outside of a frame; frame_begin comes first");
    if (filled_ != expected_)
        throw InvalidInput(
            fmt::format("frame {}: {} bytes for {}; {} were announced", *index_, filled_, content_, expected_));
    in_frame_ = false;
}

void FrameAssembler::end_of_stream() const {
    if (in_frame_)
        throw InvalidInput(
            fmt::format("the stream ended within frame {}, after {} of {} bytes", *index_, filled_, expected_));
}

}  // namespace meniscus::server
