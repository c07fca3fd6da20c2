// Where a ParticleBuffer's memory comes from, and where it goes.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "byte_pool.hpp"
#include "meniscus/client/particle_buffer.hpp"

namespace meniscus::client {

class ParticleBufferMemory {
public:
    /// Room for so many particles and levels; what it holds is undefined. Throws LimitExceeded for more particles than
    /// can be numbered.
    static ParticleBuffer pooled(BytePool& pool, std::size_t particles, std::size_t levels);
    static std::shared_ptr<const void> of(ParticleBuffer&& buffer) {
        ParticleBuffer taken = std::move(buffer);
        return std::move(taken.memory_);
    }
};

}  // namespace meniscus::client
