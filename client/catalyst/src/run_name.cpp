#include "run_name.hpp"

#include <array>
#include <cstdio>
#include <random>

namespace meniscus::catalyst {
namespace {

/// A UUID of version 4: random but for six bits.
std::string uuid_of(std::array<std::uint32_t, 4> words) {
    words[1] = (words[1] & 0xFFFF0FFFU) | 0x4000U;
    words[2] = (words[2] & 0x3FFFFFFFU) | 0x80000000U;
    std::array<char, 37> text{};
    std::snprintf(text.data(), text.size(), "%08x-%04x-%04x-%04x-%04x%08x", words[0], words[1] >> 16U,
                  words[1] & 0xFFFFU, words[2] >> 16U, words[2] & 0xFFFFU, words[3]);
    return text.data();
}

}  // namespace

RunName draw_name(const RunOptions& options, const Ranks& ranks) {
    std::random_device random;
    std::array<std::uint32_t, 5> drawn{};
    for (std::uint32_t& word : drawn) word = random();
    ranks.broadcast(drawn.data(), sizeof drawn);
    const auto given = options.session.find("session");
    return {given != options.session.end() ? given->second : uuid_of({drawn[0], drawn[1], drawn[2], drawn[3]}),
            (std::uint64_t{drawn[4]} << 16U) + 1};
}

}  // namespace meniscus::catalyst
