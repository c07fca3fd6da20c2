// Draco's header, read before Draco allocates by it.
#include "codec/draco_header.hpp"

#include <algorithm>
#include <array>

namespace meniscus {

namespace {

/// Magic word, version 2.2, triangular mesh (1), edgebreaker (1), no flags. Draco's bitstream specification, section 3.
constexpr std::array<unsigned char, 11> expected{'D', 'R', 'A', 'C', 'O', 2, 2, 1, 1, 0, 0};

class Cursor {
public:
    explicit Cursor(std::span<const std::byte> bytes) : rest_(bytes) {}

    std::optional<unsigned> byte() {
        if (rest_.empty()) return std::nullopt;
        const auto value = std::to_integer<unsigned>(rest_.front());
        rest_ = rest_.subspan(1);
        return value;
    }
    /// Seven bits a byte, the lowest first; of at most 32 bits.
    std::optional<std::uint64_t> number() {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 35; shift += 7) {
            const auto next = byte();
            if (!next) return std::nullopt;
            value |= std::uint64_t{*next & 0x7FU} << shift;
            if (*next < 0x80U) return value;
        }
        return std::nullopt;
    }

private:
    std::span<const std::byte> rest_;
};

}  // namespace

std::optional<DracoHeader> read_draco_header(std::span<const std::byte> bytes) {
    const auto is = [](unsigned char a, std::byte b) { return std::byte{a} == b; };
    if (bytes.size() < expected.size() || !std::equal(expected.begin(), expected.end(), bytes.begin(), is))
        return std::nullopt;
    Cursor cursor(bytes.subspan(expected.size()));
    const auto traversal = cursor.byte();
    const auto vertices = cursor.number();
    const auto faces = cursor.number();
    const auto connectivities = cursor.byte();
    const auto symbols = cursor.number();
    const auto split_symbols = cursor.number();
    if (!traversal || !vertices || !faces || !connectivities || !symbols || !split_symbols) return std::nullopt;
    return DracoHeader{*vertices, *faces, *symbols, *split_symbols, *connectivities};
}

}  // namespace meniscus
