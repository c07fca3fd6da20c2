#include "mutation.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace meniscus::fuzz {
namespace {

constexpr std::array<std::string_view, 14> lies{"0",
                                                "1",
                                                "-1",
                                                "3",
                                                "255",
                                                "4294967295",
                                                "18446744073709551615",
                                                "nan",
                                                "1e99",
                                                "",
                                                "99999999999",
                                                std::string_view("\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF", 8),
                                                std::string_view("\0\0\0\0", 4),
                                                std::string_view("\0\0\0\x80\0\0\0\0", 8)};

std::size_t below(std::size_t limit, std::mt19937& random) {
    return limit == 0 ? 0 : random() % limit;
}

/// A binary count that is somewhat wrong, or a power of two, of 2, 4 or 8 bytes in either byte order.
void lie_in_number(std::string& bytes, std::size_t place, std::mt19937& random) {
    const std::size_t size = std::size_t{2} << random() % 3;
    if (bytes.size() - place < size) return;
    const bool big = random() % 2 == 0;
    const auto digit = [&](std::size_t i) -> char& { return bytes[place + (big ? size - 1 - i : i)]; };
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value |= std::uint64_t{static_cast<unsigned char>(digit(i))} << 8 * i;
    value = random() % 2 == 0 ? value + random() % 9 - 4 : (std::uint64_t{1} << random() % (8 * size)) - random() % 2;
    for (std::size_t i = 0; i < size; ++i) digit(i) = static_cast<char>(value >> 8 * i & 0xFFU);
}

void damage(std::string& bytes, std::mt19937& random) {
    const std::size_t place = below(bytes.size(), random);
    const std::size_t size = 1 + below(std::min<std::size_t>(bytes.size() - place, 40), random);
    switch (random() % 9) {
        case 0:
        case 1:
            bytes[place] = static_cast<char>(random() % 256);
            return;
        case 2:
            bytes[place] = static_cast<char>(static_cast<unsigned char>(bytes[place]) ^ 1U << random() % 8);
            return;
        case 3: {
            // The next digit of a text, as numbers of headers are.
            const std::size_t digit = bytes.find_first_of("0123456789", place);
            if (digit != std::string::npos) bytes.replace(digit, 1, lies[random() % lies.size()]);
            return;
        }
        case 4: {
            const std::string_view lie = lies[random() % lies.size()];
            bytes.replace(place, std::min(lie.size(), bytes.size() - place), lie);
            return;
        }
        case 5:
            bytes.erase(place, size);
            return;
        case 6:
            bytes.insert(place, bytes.substr(place, size));
            return;
        case 7: {
            const std::string piece = bytes.substr(place, size);
            const std::size_t to = below(bytes.size() - size + 1, random);
            bytes.replace(to, size, piece);
            return;
        }
        case 8:
            lie_in_number(bytes, place, random);
            return;
    }
}

}  // namespace

std::string mutated(std::span<const std::string> seeds, std::mt19937& random) {
    const auto any_seed = [&]() -> const std::string& { return seeds[below(seeds.size(), random)]; };
    std::string bytes = any_seed();
    if (random() % 8 == 0) bytes.resize(below(bytes.size(), random));
    if (random() % 8 == 0) {
        const std::string& other = any_seed();
        bytes.replace(below(bytes.size(), random), std::string::npos, other.substr(below(other.size(), random)));
    }
    for (unsigned times = 1 + random() % 4; times > 0 && !bytes.empty(); --times) damage(bytes, random);
    return bytes;
}

}  // namespace meniscus::fuzz
