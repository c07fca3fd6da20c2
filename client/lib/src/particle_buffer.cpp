#include "meniscus/client/particle_buffer.hpp"

#include <cstddef>
#include <string>

#include "meniscus/error.hpp"
#include "particle_buffer_memory.hpp"

namespace meniscus::client {

namespace {

/// Of a frame.
constexpr std::size_t most_particles = 0xFFFFFFFE;

struct Vectors {
    std::vector<float> positions;
    std::vector<std::uint8_t> levels;
};

}  // namespace

ParticleBuffer::ParticleBuffer(std::vector<float>&& positions, std::vector<std::uint8_t>&& levels) {
    auto vectors = std::make_shared<Vectors>(Vectors{std::move(positions), std::move(levels)});
    positions_ = vectors->positions;
    levels_ = vectors->levels;
    memory_ = std::move(vectors);
}

ParticleBuffer ParticleBufferMemory::pooled(BytePool& pool, std::size_t particles, std::size_t levels) {
    if (particles > most_particles)
        throw LimitExceeded("a buffer for " + std::to_string(particles) + " particles was asked for, at most " +
                            std::to_string(most_particles) + " can be numbered: split the frame");
    const std::size_t position_bytes = 3 * sizeof(float) * particles;
    auto bytes = pool.take(position_bytes + levels);
    // The pool's memory is aligned for any number.
    auto* positions = reinterpret_cast<float*>(bytes->data());
    auto* first_level = reinterpret_cast<std::uint8_t*>(bytes->data() + position_bytes);
    return {std::move(bytes), {positions, 3 * particles}, {first_level, levels}};
}

}  // namespace meniscus::client
