#include "pushed_frame.hpp"

#include <cstring>
#include <span>
#include <string>

#include "conversion/particle_arrays.hpp"
#include "conversion/settings_conversion.hpp"
#include "meniscus/error.hpp"

namespace meniscus::client {

PushedFrame copy_frame(const ParticleFrame& frame, std::uint64_t index, double simulation_time, BytePool& pool) {
    if (!frame.arrays.empty())
        throw InvalidInput("frame " + std::to_string(index) + " brings the array \"" +
                           std::string(frame.arrays.front().name) + "\"; servers take positions and levels alone");
    PushedFrame copy;
    copy.begin.set_frame_index(index);
    copy.begin.set_simulation_time(simulation_time);
    copy.begin.set_particle_count(frame.count());
    *copy.begin.mutable_arrays() = conversion::particle_arrays(frame.is_quantized(), !frame.levels.empty());
    if (frame.is_quantized()) *copy.begin.mutable_quantization_box() = conversion::to_wire(frame.quantization_box);
    copy.bytes = pool.take(frame.positions.size_bytes() + frame.quantized.size_bytes() + frame.levels.size_bytes());
    std::byte* place = copy.bytes->data();
    const auto append = [&place](std::span<const std::byte> part) {
        if (part.empty()) return;
        std::memcpy(place, part.data(), part.size());
        place += part.size();
    };
    append(std::as_bytes(frame.positions));
    append(std::as_bytes(frame.quantized));
    append(std::as_bytes(frame.levels));
    return copy;
}

}  // namespace meniscus::client
