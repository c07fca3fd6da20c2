#include "mutation.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
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

void damage(std::string& bytes, std::mt19937& random) {
    const std::size_t place = below(bytes.size(), random);
    const std::size_t size = 1 + below(std::min<std::size_t>(bytes.size() - place, 40), random);
    switch (random() % 8) {
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
    }
}

}  // namespace

std::string mutated(const std::string& seed, std::mt19937& random) {
    std::string bytes = seed;
    if (random() % 8 == 0) bytes.resize(below(bytes.size(), random));
    for (unsigned times = 1 + random() % 4; times > 0 && !bytes.empty(); --times) damage(bytes, random);
    return bytes;
}

}  // namespace meniscus::fuzz
