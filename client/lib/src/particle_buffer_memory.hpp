// Where a ParticleBuffer's memory comes from, and where it goes.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "byte_pool.hpp"
#include "meniscus/client/particle_buffer.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus::client {

class ParticleBufferMemory {
public:
    /// Room for this number of particles and levels, and for these arrays; what it holds is undefined. Throws
    /// LimitExceeded for more particles than can be numbered, InvalidInput for arrays without components.
    static ParticleBuffer pooled(BytePool& pool, std::size_t particles, std::size_t levels,
                                 std::span<const ArrayForm> arrays = {});
    static std::vector<ParticleArray> arrays_of(const ParticleBuffer& buffer) {
        std::vector<ParticleArray> views;
        for (const auto& [form, bytes] : buffer.arrays_)
            views.push_back({.name = form.name, .data = bytes, .type = form.type, .components = form.components});
        return views;
    }
    static bool has_arrays(const ParticleBuffer& buffer) { return !buffer.arrays_.empty(); }
    /// The bytes of the further array at this place.
    static std::span<std::byte> bytes_of(const ParticleBuffer& buffer, std::size_t place) {
        return buffer.arrays_[place].bytes;
    }
    static std::shared_ptr<const void> of(ParticleBuffer&& buffer) {
        ParticleBuffer taken = std::move(buffer);
        return std::move(taken.memory_);
    }
};

}  // namespace meniscus::client
