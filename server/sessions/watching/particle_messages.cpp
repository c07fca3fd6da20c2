#include "sessions/watching/particle_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>
#include <string>

#include "conversion/particle_arrays.hpp"
#include "conversion/settings_conversion.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/limits/limits.hpp"

namespace meniscus::server {

namespace {

constexpr double steps = 65535.0;  // of a uint16

/// The box of every stride-th particle; of one point without any.
Box bounds(std::span<const float> positions, std::size_t stride) {
    Box box{};
    for (std::size_t axis = 0; axis < 3 && !positions.empty(); ++axis) {
        float low = positions[axis];
        float high = low;
        for (std::size_t at = axis; at < positions.size(); at += 3 * stride) {
            low = std::min(low, positions[at]);
            high = std::max(high, positions[at]);
        }
        box.min[axis] = low;
        box.max[axis] = high;
    }
    return box;
}

/// The bytes of every stride-th particle, in the order of the wire: all positions, then all levels.
std::string bytes_of(const ParticleFrame& particles, const Box& box, std::size_t stride, std::size_t sent) {
    constexpr std::size_t position_bytes = 3 * sizeof(std::uint16_t);
    std::string bytes(sent * (position_bytes + (particles.levels.empty() ? 0U : 1U)), '\0');
    std::array<double, 3> scale{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double extent = box.max[axis] - box.min[axis];
        if (extent > 0.0) scale[axis] = steps / extent;
    }
    for (std::size_t i = 0; i < sent; ++i) {
        const std::size_t from = 3 * stride * i;
        std::array<std::uint16_t, 3> position{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            position[axis] = particles.is_quantized()
                                 ? particles.quantized[from + axis]
                                 : static_cast<std::uint16_t>(
                                       std::lrint((particles.positions[from + axis] - box.min[axis]) * scale[axis]));
        std::memcpy(bytes.data() + i * position_bytes, position.data(), position_bytes);
        if (!particles.levels.empty())
            bytes[sent * position_bytes + i] = static_cast<char>(particles.levels[stride * i]);
    }
    return bytes;
}

}  // namespace

std::uint64_t stride_for(std::uint64_t count, std::uint64_t max_particles) {
    if (max_particles == 0 || count <= max_particles) return 1;
    return (count - 1) / max_particles + 1;
}

ParticleMessages encode_particles(const InputFrame& frame, std::uint64_t run_id, double particle_radius,
                                  std::uint64_t stride) {
    const ParticleFrame particles = frame.view();
    const std::uint64_t sent = (particles.count() + stride - 1) / stride;
    const Box box = particles.is_quantized() ? particles.quantization_box : bounds(particles.positions, stride);

    ParticleMessages result{.received_at = frame.received_at, .messages = {}};
    const auto add = [&](const v1::WatchParticlesResponse& response) {
        result.messages.push_back(std::make_shared<const std::string>(response.SerializeAsString()));
        result.bytes += result.messages.back()->size();
    };
    v1::WatchParticlesResponse response;
    v1::ParticlesBegin& begin = *response.mutable_particles_begin();
    begin.set_frame_index(frame.index);
    begin.set_run_id(run_id);
    begin.set_simulation_time(frame.simulation_time);
    begin.set_particle_count(particles.count());
    begin.set_stride(stride);
    begin.set_sent_count(sent);
    *begin.mutable_quantization_box() = conversion::to_wire(box);
    *begin.mutable_arrays() = conversion::particle_arrays(true, !particles.levels.empty());
    begin.set_particle_radius(particle_radius);
    add(response);
    const std::string bytes = bytes_of(particles, box, stride, sent);
    for (std::size_t at = 0; at < bytes.size(); at += chunk_bytes) {
        response.mutable_frame_chunk()->set_data(bytes.data() + at, std::min(chunk_bytes, bytes.size() - at));
        add(response);
    }
    response.mutable_frame_end();
    add(response);
    return result;
}

}  // namespace meniscus::server
