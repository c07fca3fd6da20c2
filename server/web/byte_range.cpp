#include "web/byte_range.hpp"

#include <strings.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace meniscus::server {

namespace {

/// A number of digits alone; one that is too large is the largest. None: it is no number.
std::optional<std::uint64_t> number_of(std::string_view text) {
    if (text.empty() || !std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; })) return std::nullopt;
    constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t number = 0;
    for (const char c : text) {
        const auto digit = static_cast<std::uint64_t>(c - '0');
        if (number > (most - digit) / 10) return most;
        number = 10 * number + digit;
    }
    return number;
}

}  // namespace

std::optional<ByteRange> byte_range(std::string_view header, std::size_t size) {
    constexpr std::string_view unit = "bytes=";
    if (header.size() <= unit.size() || ::strncasecmp(header.data(), unit.data(), unit.size()) != 0)
        return std::nullopt;
    header.remove_prefix(unit.size());
    const std::size_t dash = header.find('-');
    if (dash == std::string_view::npos) return std::nullopt;
    const std::string_view from = header.substr(0, dash);
    const std::string_view to = header.substr(dash + 1);
    const auto last = number_of(to);
    if (from.empty()) {
        if (!last) return std::nullopt;
        const std::size_t length = std::min<std::uint64_t>(*last, size);
        return ByteRange{.first = size - length, .length = length};
    }
    const auto first = number_of(from);
    if (!first || (!to.empty() && (!last || *last < *first))) return std::nullopt;
    if (*first >= size) return ByteRange{};
    return ByteRange{.first = *first, .length = std::min<std::uint64_t>(last.value_or(size), size - 1) - *first + 1};
}

}  // namespace meniscus::server
