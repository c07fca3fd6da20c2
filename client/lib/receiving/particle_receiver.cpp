#include "receiving/particle_receiver.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "conversion/settings_conversion.hpp"
#include "meniscus/error.hpp"

namespace meniscus::client {

namespace {

std::string name_of(std::uint64_t index) {
    return "the particles of frame " + std::to_string(index);
}

Box box_of(const v1::ParticlesBegin& message) {
    Box box;
    try {
        box = conversion::from_wire(message.quantization_box(), "quantization_box");
    } catch (const InvalidInput& error) {
        throw ServerError(name_of(message.frame_index()) + ": " + error.what());
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis]) || box.min[axis] > box.max[axis])
            throw ServerError(name_of(message.frame_index()) + " lie in a box from " + std::to_string(box.min[axis]) +
                              " to " + std::to_string(box.max[axis]));
    return box;
}

conversion::ParticleLayout layout_of(const v1::ParticlesBegin& message) {
    try {
        auto layout = conversion::particle_layout(message.arrays());
        if (!layout.quantized) throw InvalidInput("positions of float32; they must be of uint16");
        return layout;
    } catch (const InvalidInput& error) {
        throw ServerError(name_of(message.frame_index()) + ": " + error.what());
    }
}

}  // namespace

std::optional<ReceivedParticles> ParticleReceiver::take(const v1::WatchParticlesResponse& response) {
    switch (response.message_case()) {
        case v1::WatchParticlesResponse::kParticlesBegin:
            begin(response.particles_begin());
            return std::nullopt;
        case v1::WatchParticlesResponse::kFrameChunk:
            add(response.frame_chunk());
            return std::nullopt;
        case v1::WatchParticlesResponse::kFrameEnd:
            return end();
        case v1::WatchParticlesResponse::kDraining:
            return std::nullopt;
        case v1::WatchParticlesResponse::MESSAGE_NOT_SET:
            break;
    }
    throw ServerError("the server sent a message of a kind that this version does not know");
}

void ParticleReceiver::begin(const v1::ParticlesBegin& message) {
    const std::string name = name_of(message.frame_index());
    const std::uint64_t count = message.particle_count();
    const std::uint64_t stride = message.stride();
    const std::uint64_t sent = message.sent_count();
    if (stride == 0 || sent != count / stride + (count % stride == 0 ? 0U : 1U))
        throw ServerError(name + ": " + std::to_string(sent) + " of " + std::to_string(count) + " are no " +
                          std::to_string(stride) + "-th part");
    const conversion::ParticleLayout layout = layout_of(message);
    if (sent > std::numeric_limits<std::ptrdiff_t>::max() / layout.particle_bytes)
        throw ServerError(name + ": " + std::to_string(sent) + " are more than memory can hold");
    if (!(message.particle_radius() > 0.0) || !std::isfinite(message.particle_radius()))
        throw ServerError(name + " have the radius " + std::to_string(message.particle_radius()));
    Frame frame;
    frame.header.index = message.frame_index();
    frame.header.run_id = message.run_id();
    frame.header.simulation_time = message.simulation_time();
    frame.header.frame_count = count;
    frame.header.stride = stride;
    frame.header.particle_radius = message.particle_radius();
    frame.header.quantization_box = box_of(message);
    frame.layout = layout;
    frame.sent_count = sent;
    frame.expected_bytes = sent * layout.particle_bytes;
    frame_ = std::move(frame);
}

void ParticleReceiver::add(const v1::FrameChunk& message) {
    if (!frame_) throw ServerError("the server sent particles outside of a frame");
    const std::string& data = message.data();
    if (data.size() > frame_->expected_bytes - frame_->bytes.size())
        throw ServerError(name_of(frame_->header.index) + " have more bytes than the " +
                          std::to_string(frame_->expected_bytes) + " announced");
    const auto* bytes = reinterpret_cast<const std::byte*>(data.data());
    frame_->bytes.insert(frame_->bytes.end(), bytes, bytes + data.size());
}

ReceivedParticles ParticleReceiver::end() {
    if (!frame_) throw ServerError("the server ended particles that it had not begun");
    const Frame frame = *std::exchange(frame_, std::nullopt);
    if (frame.bytes.size() != frame.expected_bytes)
        throw ServerError(name_of(frame.header.index) + " ended after " + std::to_string(frame.bytes.size()) + " of " +
                          std::to_string(frame.expected_bytes) + " bytes");
    ReceivedParticles particles = frame.header;
    if (frame.sent_count == 0) return particles;
    particles.quantized.resize(3 * frame.sent_count);
    std::memcpy(particles.quantized.data(), frame.bytes.data(), frame.sent_count * frame.layout.position_bytes);
    if (frame.layout.has_levels) {
        particles.levels.resize(frame.sent_count);
        std::memcpy(particles.levels.data(), frame.bytes.data() + frame.sent_count * frame.layout.levels_after,
                    frame.sent_count);
        const std::uint8_t highest = *std::ranges::max_element(particles.levels);
        if (highest > max_particle_level)
            throw ServerError(name_of(particles.index) + " have the level " + std::to_string(highest));
    }
    return particles;
}

void ParticleReceiver::end_of_stream() const {
    if (frame_) throw ServerError("the server ended the stream within " + name_of(frame_->header.index));
}

}  // namespace meniscus::client
