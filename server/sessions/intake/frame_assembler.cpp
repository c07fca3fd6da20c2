#include "sessions/intake/frame_assembler.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "conversion/particle_arrays.hpp"
#include "conversion/settings_conversion.hpp"
#include "meniscus/error.hpp"
#include "sessions/limits/limit_reached.hpp"

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

FramePlan FrameAssembler::plan(const v1::FrameBegin& message, const conversion::ParticleLayout& layout) const {
    const std::vector<conversion::FurtherArray> kept = arrays_to_keep(layout, message.particle_count(), settings_);
    const std::uint64_t count = message.particle_count();
    if (limits_.particles_per_frame != 0 && count > limits_.particles_per_frame)
        throw LimitExceeded(fmt::format("frame {}: {} particles; the server takes at most {} per frame",
                                        message.frame_index(), count, limits_.particles_per_frame));
    constexpr std::uint64_t countable = std::numeric_limits<std::ptrdiff_t>::max();
    const std::uint64_t limit = limits_.bytes_per_session != 0 ? limits_.bytes_per_session : countable;
    const std::uint64_t particle_bytes = kept_bytes_per_particle(layout, kept);
    if (count > limit / particle_bytes)
        throw LimitExceeded(
            fmt::format("frame {}: {} particles of {} bytes; the server holds at most {} bytes per session",
                        message.frame_index(), count, particle_bytes, limit));
    if (count > countable / layout.particle_bytes)
        throw LimitExceeded(fmt::format("frame {}: {} particles of {} bytes; the server takes at most {} bytes",
                                        message.frame_index(), count, layout.particle_bytes, countable));
    return plan_frame(layout, kept, static_cast<std::size_t>(count));
}

void FrameAssembler::begin(const v1::FrameBegin& message, InputFrame& frame) {
    if (in_frame_)
        throw InvalidInput(fmt::format("frame {} begins before frame {} has ended", message.frame_index(), *index_));
    if (index_ && message.frame_index() <= *index_)
        throw InvalidInput(
            fmt::format("frame index {} after {}; indices must increase", message.frame_index(), *index_));
    if (!std::isfinite(message.simulation_time()))
        throw InvalidInput(fmt::format("frame {}: simulation_time is {}; it must be finite", message.frame_index(),
                                       message.simulation_time()));
    conversion::ParticleLayout layout;
    try {
        layout = conversion::particle_layout(message.arrays());
        plan_ = plan(message, layout);
    } catch (const InvalidInput& error) {
        throw InvalidInput(fmt::format("frame {}: {}", message.frame_index(), error.what()));
    }
    const Box box = layout.quantized ? quantization_box(message) : Box{};
    expected_ = static_cast<std::size_t>(message.particle_count() * layout.particle_bytes);

    try {
        frame.allocate(plan_.bytes);
    } catch (const LimitReached& error) {
        throw LimitReached(error.limit(), fmt::format("frame {}: {}", message.frame_index(), error.what()));
    } catch (const LimitExceeded& error) {
        throw LimitExceeded(fmt::format("frame {}: {}", message.frame_index(), error.what()));
    }
    frame.index = message.frame_index();
    frame.simulation_time = message.simulation_time();
    frame.particle_count = static_cast<std::size_t>(message.particle_count());
    frame.quantized = layout.quantized;
    frame.quantization_box = box;
    frame.has_levels = layout.has_levels;
    frame.keep_arrays(std::move(plan_.arrays));
    index_ = message.frame_index();
    piece_ = 0;
    filled_ = 0;
    kept_ = 0;
    chunks_ = 0;
    in_frame_ = true;
}

void FrameAssembler::append(const v1::FrameChunk& message, InputFrame& frame) {
    ChunkSource source(message);
    append(message.data().size(), frame, source);
}

void FrameAssembler::admit_chunk(std::size_t bytes, const InputFrame& frame) {
    if (!in_frame_) throw InvalidInput("a chunk outside of a frame; frame_begin comes first");
    if (bytes > chunk_bytes)
        throw InvalidInput(
            fmt::format("frame {}: a chunk of {} bytes; at most {} are allowed", *index_, bytes, chunk_bytes));
    if (limits_.chunks_per_frame != 0 && chunks_ >= limits_.chunks_per_frame)
        throw LimitExceeded(
            fmt::format("frame {}: more than {} chunks; the server takes at most {} per frame: send larger ones",
                        *index_, chunks_, limits_.chunks_per_frame));
    if (bytes > expected_ - filled_)
        throw InvalidInput(fmt::format("frame {}: at least {} bytes for {} particles; {} were announced", *index_,
                                       filled_ + bytes, frame.particle_count, expected_));
    ++chunks_;
}

void FrameAssembler::end(InputFrame& frame) {
    if (!in_frame_) throw InvalidInput("frame_end outside of a frame; frame_begin comes first");
    if (filled_ != expected_)
        throw InvalidInput(fmt::format("frame {}: {} bytes for {} particles; {} were announced", *index_, filled_,
                                       frame.particle_count, expected_));
    frame.received_at = std::chrono::steady_clock::now();
    in_frame_ = false;
}

void FrameAssembler::end_of_stream() const {
    if (in_frame_)
        throw InvalidInput(
            fmt::format("the stream ended within frame {}, after {} of {} bytes", *index_, filled_, expected_));
}

}  // namespace meniscus::server
