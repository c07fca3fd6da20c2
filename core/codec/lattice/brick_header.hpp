// The first two bytes of a lattice brick.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "lattice/host_device.hpp"

namespace meniscus {

inline constexpr unsigned lattice_version = 1;

struct BrickHeader {
    bool has_entropy = false;    ///< the profile
    bool has_one_level = false;  ///< all cells that draw have the same level
    int offset_bits = 0;
    int normal_bits = 0;

    static constexpr std::size_t size = 2;  ///< bytes

    /// The bytes, the first one lowest.
    MENISCUS_HD std::uint32_t word() const {
        const unsigned flags = (has_entropy ? entropy : 0U) | (has_one_level ? one_level : 0U);
        return lattice_version | flags << 4 | static_cast<unsigned>(offset_bits - 1) << 8 |
               static_cast<unsigned>(normal_bits) << 11;
    }
    std::array<std::byte, size> bytes() const {
        return {static_cast<std::byte>(word() & 0xFF), static_cast<std::byte>(word() >> 8)};
    }
    /// None for another version, and for a flag that is kept for later ones.
    static std::optional<BrickHeader> read(std::span<const std::byte> bytes) {
        if (bytes.size() < size) return std::nullopt;
        const auto first = std::to_integer<unsigned>(bytes[0]);
        const auto second = std::to_integer<unsigned>(bytes[1]);
        BrickHeader header;
        const unsigned flags = first >> 4;
        header.has_entropy = (flags & entropy) != 0;
        header.has_one_level = (flags & one_level) != 0;
        header.offset_bits = static_cast<int>(second & 7) + 1;
        header.normal_bits = static_cast<int>(second >> 3);
        if ((first & 15) != lattice_version || (flags & kept) != 0 || header.offset_bits < 2) return std::nullopt;
        if (header.normal_bits == 1 || header.normal_bits > 16) return std::nullopt;
        return header;
    }

private:
    static constexpr unsigned entropy = 1;
    static constexpr unsigned one_level = 4;
    /// Rows of signs by entropy in a packed brick, and a brick that refers to the one before.
    static constexpr unsigned kept = 2 | 8;
};

}  // namespace meniscus
