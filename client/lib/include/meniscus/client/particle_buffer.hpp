// Particles in memory that a stream takes over, so that pushing them copies nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace meniscus::client {

/// From Stream::next_buffer(), to write into; or made of vectors that are no longer needed. What was pushed or moved
/// from holds nothing any more.
class ParticleBuffer {
public:
    /// positions: x y z per particle, world units. levels: empty, or one per particle, 0 (finest) to 3.
    explicit ParticleBuffer(std::vector<float>&& positions, std::vector<std::uint8_t>&& levels = {});
    ParticleBuffer(ParticleBuffer&& other) noexcept
        : memory_(std::move(other.memory_)),
          positions_(std::exchange(other.positions_, {})),
          levels_(std::exchange(other.levels_, {})) {}
    ParticleBuffer& operator=(ParticleBuffer&& other) noexcept {
        memory_ = std::move(other.memory_);
        positions_ = std::exchange(other.positions_, {});
        levels_ = std::exchange(other.levels_, {});
        return *this;
    }

    std::span<float> positions() const noexcept { return positions_; }
    std::span<std::uint8_t> levels() const noexcept { return levels_; }
    /// Whether it was pushed or moved from.
    bool is_taken() const noexcept { return memory_ == nullptr; }

private:
    friend class ParticleBufferMemory;
    ParticleBuffer(std::shared_ptr<const void> memory, std::span<float> positions, std::span<std::uint8_t> levels)
        : memory_(std::move(memory)), positions_(positions), levels_(levels) {}

    std::shared_ptr<const void> memory_;
    std::span<float> positions_;
    std::span<std::uint8_t> levels_;
};

}  // namespace meniscus::client
