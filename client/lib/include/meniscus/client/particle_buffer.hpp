// Particles in memory that a stream takes over, so that pushing them copies nothing.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "meniscus/element_type.hpp"

namespace meniscus::client {

/// The numbers that arrays consist of.
template <class Number>
concept ArrayNumber = std::same_as<Number, float> || std::same_as<Number, std::uint8_t> ||
    std::same_as<Number, std::int32_t> || std::same_as<Number, std::uint32_t>;

template <ArrayNumber Number>
constexpr ElementType element_type_of() {
    if constexpr (std::same_as<Number, float>) return ElementType::float32;
    if constexpr (std::same_as<Number, std::uint8_t>) return ElementType::uint8;
    if constexpr (std::same_as<Number, std::int32_t>) return ElementType::int32;
    return ElementType::uint32;
}

/// The form of an array, without its values.
struct ArrayForm {
    std::string name;
    ElementType type = ElementType::float32;
    std::size_t components = 1;  ///< numbers per particle
};

/// From Stream::next_buffer(), to write into; or made of vectors that are no longer needed. What was pushed or moved
/// from holds nothing any more.
class ParticleBuffer {
public:
    /// positions: x y z per particle, world units. levels: empty, or one per particle, 0 (finest) to 3.
    explicit ParticleBuffer(std::vector<float>&& positions, std::vector<std::uint8_t>&& levels = {});
    ParticleBuffer(ParticleBuffer&& other) noexcept
        : memory_(std::move(other.memory_)),
          positions_(std::exchange(other.positions_, {})),
          levels_(std::exchange(other.levels_, {})),
          arrays_(std::exchange(other.arrays_, {})) {}
    ParticleBuffer& operator=(ParticleBuffer&& other) noexcept {
        memory_ = std::move(other.memory_);
        positions_ = std::exchange(other.positions_, {});
        levels_ = std::exchange(other.levels_, {});
        arrays_ = std::exchange(other.arrays_, {});
        return *this;
    }

    /// A further array, of a vector that is no longer needed. values: `components` for each particle.
    template <ArrayNumber Number>
    void add(std::string name, std::vector<Number>&& values, std::size_t components = 1) {
        using Kept = std::pair<std::shared_ptr<const void>, std::vector<Number>>;
        auto kept = std::make_shared<Kept>(memory_, std::move(values));
        arrays_.push_back({{std::move(name), element_type_of<Number>(), components},
                           std::as_writable_bytes(std::span(kept->second))});
        memory_ = std::move(kept);
    }

    std::span<float> positions() const noexcept { return positions_; }
    std::span<std::uint8_t> levels() const noexcept { return levels_; }
    /// The values of a further array. Throws InvalidInput for one that the buffer does not have, or that is of another
    /// type.
    template <ArrayNumber Number>
    std::span<Number> array(std::string_view name) const {
        const std::span<std::byte> bytes = array_bytes(name, element_type_of<Number>());
        return {reinterpret_cast<Number*>(bytes.data()), bytes.size() / sizeof(Number)};
    }
    /// Whether it was pushed or moved from.
    bool is_taken() const noexcept { return memory_ == nullptr; }

private:
    friend class ParticleBufferMemory;
    struct FurtherArray {
        ArrayForm form;
        std::span<std::byte> bytes;
    };

    ParticleBuffer(std::shared_ptr<const void> memory, std::span<float> positions, std::span<std::uint8_t> levels,
                   std::vector<FurtherArray> arrays)
        : memory_(std::move(memory)), positions_(positions), levels_(levels), arrays_(std::move(arrays)) {}
    std::span<std::byte> array_bytes(std::string_view name, ElementType type) const;

    std::shared_ptr<const void> memory_;
    std::span<float> positions_;
    std::span<std::uint8_t> levels_;
    std::vector<FurtherArray> arrays_;
};

}  // namespace meniscus::client
