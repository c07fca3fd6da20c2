#include "pushed_frame.hpp"

#include <cstring>
#include <string>
#include <utility>

#include "conversion/particle_arrays.hpp"
#include "conversion/settings_conversion.hpp"
#include "meniscus/error.hpp"
#include "meniscus/reconstructor.hpp"
#include "particle_buffer_memory.hpp"

namespace meniscus::client {

namespace {

/// Without its bytes.
PushedFrame begin_frame(const ParticleFrame& frame, std::uint64_t index, double simulation_time) {
    validate_lengths(frame);
    if (!frame.arrays.empty())
        throw InvalidInput("frame " + std::to_string(index) + " brings the array \"" +
                           std::string(frame.arrays.front().name) + "\"; servers take positions and levels alone");
    PushedFrame pushed;
    pushed.begin.set_frame_index(index);
    pushed.begin.set_simulation_time(simulation_time);
    pushed.begin.set_particle_count(frame.count());
    *pushed.begin.mutable_arrays() = conversion::particle_arrays(frame.is_quantized(), !frame.levels.empty());
    if (frame.is_quantized()) *pushed.begin.mutable_quantization_box() = conversion::to_wire(frame.quantization_box);
    return pushed;
}

}  // namespace

PushedFrame copy_frame(const ParticleFrame& frame, std::uint64_t index, double simulation_time, BytePool& pool) {
    PushedFrame copy = begin_frame(frame, index, simulation_time);
    auto bytes = pool.take(frame.positions.size_bytes() + frame.quantized.size_bytes() + frame.levels.size_bytes());
    std::byte* place = bytes->data();
    const auto append = [&place](std::span<const std::byte> part) {
        if (part.empty()) return;
        std::memcpy(place, part.data(), part.size());
        place += part.size();
    };
    append(std::as_bytes(frame.positions));
    append(std::as_bytes(frame.quantized));
    append(std::as_bytes(frame.levels));
    copy.parts.emplace_back(bytes->data(), bytes->size());
    copy.memory = std::move(bytes);
    return copy;
}

PushedFrame copy_frame(const StridedPositions& positions, std::span<const std::uint8_t> levels, std::uint64_t index,
                       double simulation_time, BytePool& pool) {
    ParticleBuffer buffer = ParticleBufferMemory::pooled(pool, positions.count(), levels.size());
    if (!levels.empty()) std::memcpy(buffer.levels().data(), levels.data(), levels.size());
    positions.copy_to(buffer.positions());
    return take_frame(buffer, index, simulation_time);
}

PushedFrame take_frame(ParticleBuffer& buffer, std::uint64_t index, double simulation_time) {
    if (buffer.is_taken())
        throw InvalidInput("frame " + std::to_string(index) +
                           " comes in a buffer that was pushed or moved from before: take a new one for each frame");
    ParticleFrame frame;
    frame.positions = buffer.positions();
    frame.levels = buffer.levels();
    PushedFrame pushed = begin_frame(frame, index, simulation_time);
    pushed.parts = {std::as_bytes(frame.positions), std::as_bytes(frame.levels)};
    pushed.memory = ParticleBufferMemory::of(std::move(buffer));
    return pushed;
}

}  // namespace meniscus::client
