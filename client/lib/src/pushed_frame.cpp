#include "pushed_frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "conversion/particle_arrays.hpp"
#include "conversion/settings_conversion.hpp"
#include "meniscus/error.hpp"
#include "meniscus/reconstructor.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "particle_buffer_memory.hpp"

namespace meniscus::client {

namespace {

/// A frame without its bytes. arrays: those beside positions and levels.
PushedFrame begin_frame(const ParticleFrame& frame, std::span<const ParticleArray> arrays, std::uint64_t index,
                        double simulation_time) {
    if (!std::isfinite(simulation_time))
        throw InvalidInput("frame " + std::to_string(index) + ": simulation_time is " +
                           std::to_string(simulation_time) + "; it must be finite");
    v1::StreamRequest request;
    v1::FrameBegin& begin = *request.mutable_frame_begin();
    begin.set_frame_index(index);
    begin.set_simulation_time(simulation_time);
    begin.set_particle_count(frame.count());
    *begin.mutable_arrays() = conversion::particle_arrays(frame.is_quantized(), !frame.levels.empty(), arrays);
    if (frame.is_quantized()) *begin.mutable_quantization_box() = conversion::to_wire(frame.quantization_box);
    return {.index = index, .begin = request.SerializeAsString(), .memory = nullptr, .parts = {}};
}

std::vector<ParticleArray> chosen_arrays(std::span<const ParticleArray> arrays, std::size_t particles,
                                         const NamedArrays& named, std::uint64_t index) {
    try {
        return named.of(arrays, particles);
    } catch (const InvalidInput& error) {
        throw InvalidInput("frame " + std::to_string(index) + ": " + error.what());
    }
}

}  // namespace

PushedFrame copy_frame(const ParticleFrame& frame, const NamedArrays& named, std::uint64_t index,
                       double simulation_time, BytePool& pool) {
    validate_lengths(frame);
    const std::vector<ParticleArray> arrays = chosen_arrays(frame.arrays, frame.count(), named, index);
    PushedFrame copy = begin_frame(frame, arrays, index, simulation_time);
    std::size_t size = frame.positions.size_bytes() + frame.quantized.size_bytes() + frame.levels.size_bytes();
    for (const ParticleArray& array : arrays) size += array.data.size();
    auto bytes = pool.take(size);
    std::byte* place = bytes->data();
    const auto append = [&place](std::span<const std::byte> part) {
        if (part.empty()) return;
        std::memcpy(place, part.data(), part.size());
        place += part.size();
    };
    append(std::as_bytes(frame.positions));
    append(std::as_bytes(frame.quantized));
    append(std::as_bytes(frame.levels));
    for (const ParticleArray& array : arrays) append(array.data);
    copy.parts.emplace_back(bytes->data(), bytes->size());
    copy.memory = std::move(bytes);
    return copy;
}

PushedFrame copy_frame(const StridedPositions& positions, std::span<const std::uint8_t> levels,
                       std::span<const ParticleArray> arrays, const NamedArrays& named, std::uint64_t index,
                       double simulation_time, BytePool& pool) {
    const std::vector<ParticleArray> chosen = chosen_arrays(arrays, positions.count(), named, index);
    std::vector<ArrayForm> forms;
    forms.reserve(chosen.size());
    for (const ParticleArray& array : chosen) forms.push_back({std::string(array.name), array.type, array.components});
    ParticleBuffer buffer = ParticleBufferMemory::pooled(pool, positions.count(), levels.size(), forms);
    ParticleFrame given;
    given.positions = buffer.positions();
    given.levels = levels;
    given.arrays = arrays;
    validate_lengths(given);
    for (std::size_t a = 0; a < chosen.size(); ++a)
        std::ranges::copy(chosen[a].data, ParticleBufferMemory::bytes_of(buffer, a).begin());
    if (!levels.empty()) std::memcpy(buffer.levels().data(), levels.data(), levels.size());
    positions.copy_to(buffer.positions());
    return take_frame(buffer, named, index, simulation_time);
}

PushedFrame take_frame(ParticleBuffer& buffer, const NamedArrays& named, std::uint64_t index, double simulation_time) {
    if (buffer.is_taken())
        throw InvalidInput("frame " + std::to_string(index) +
                           " comes in a buffer that was pushed or moved from before: take a new one for each frame");
    const std::vector<ParticleArray> brought = ParticleBufferMemory::arrays_of(buffer);
    ParticleFrame frame;
    frame.positions = buffer.positions();
    frame.levels = buffer.levels();
    frame.arrays = brought;
    validate_lengths(frame);
    const std::vector<ParticleArray> arrays = chosen_arrays(frame.arrays, frame.count(), named, index);
    PushedFrame pushed = begin_frame(frame, arrays, index, simulation_time);
    pushed.parts = {std::as_bytes(frame.positions), std::as_bytes(frame.levels)};
    for (const ParticleArray& array : arrays) pushed.parts.push_back(array.data);
    pushed.memory = ParticleBufferMemory::of(std::move(buffer));
    return pushed;
}

}  // namespace meniscus::client
