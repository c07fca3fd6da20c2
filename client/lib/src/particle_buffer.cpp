#include "meniscus/client/particle_buffer.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "meniscus/error.hpp"
#include "particle_buffer_memory.hpp"

namespace meniscus::client {

namespace {

/// The most particles of a frame.
constexpr std::size_t most_particles = 0xFFFFFFFE;
/// The most components of an array, far more than any has: their product with the particles' number fits.
constexpr std::size_t most_components = 1024;

struct Vectors {
    std::vector<float> positions;
    std::vector<std::uint8_t> levels;
};

/// Where the next array of numbers may begin.
constexpr std::size_t aligned(std::size_t bytes) {
    constexpr std::size_t number = sizeof(float);
    return (bytes + number - 1) / number * number;
}

std::size_t array_size(const ArrayForm& form, std::size_t particles) {
    if (form.components < 1 || form.components > most_components)
        throw InvalidInput("a buffer with an array '" + form.name + "' of " + std::to_string(form.components) +
                           " components was asked for; it must have 1 to " + std::to_string(most_components));
    return size_of(form.type) * form.components * particles;
}

}  // namespace

ParticleBuffer::ParticleBuffer(std::vector<float>&& positions, std::vector<std::uint8_t>&& levels) {
    auto vectors = std::make_shared<Vectors>(Vectors{std::move(positions), std::move(levels)});
    positions_ = vectors->positions;
    levels_ = vectors->levels;
    memory_ = std::move(vectors);
}

std::span<std::byte> ParticleBuffer::array_bytes(std::string_view name, ElementType type) const {
    const auto array = std::ranges::find(arrays_, name, [](const FurtherArray& a) { return a.form.name; });
    if (array == arrays_.end()) throw InvalidInput("the buffer has no array '" + std::string(name) + "'");
    if (array->form.type != type)
        throw InvalidInput("array '" + std::string(name) + "' of the buffer is of " +
                           std::string(name_of(array->form.type)) + ", not of " + std::string(name_of(type)));
    return array->bytes;
}

ParticleBuffer ParticleBufferMemory::pooled(BytePool& pool, std::size_t particles, std::size_t levels,
                                            std::span<const ArrayForm> arrays) {
    if (particles > most_particles)
        throw LimitExceeded("a buffer for " + std::to_string(particles) + " particles was asked for, at most " +
                            std::to_string(most_particles) + " can be numbered: split the frame");
    const std::size_t position_bytes = 3 * sizeof(float) * particles;
    std::size_t size = position_bytes;
    for (const ArrayForm& form : arrays) size += aligned(array_size(form, particles));
    auto bytes = pool.take(size + levels);
    // The pool's memory is aligned for any number.
    std::byte* place = bytes->data();
    auto* positions = reinterpret_cast<float*>(place);
    place += position_bytes;
    std::vector<ParticleBuffer::FurtherArray> further;
    for (const ArrayForm& form : arrays) {
        const std::size_t array_bytes = array_size(form, particles);
        further.push_back({form, {place, array_bytes}});
        place += aligned(array_bytes);
    }
    auto* first_level = reinterpret_cast<std::uint8_t*>(place);
    return {std::move(bytes), {positions, 3 * particles}, {first_level, levels}, std::move(further)};
}

}  // namespace meniscus::client
