// The bits of normals, for which Stream and Watch ask alike.
#pragma once

#include <fmt/format.h>

#include "meniscus/error.hpp"

namespace meniscus::server {

/// message: a StreamOpen or a WatchRequest. Throws InvalidInput for a value out of range.
template <class Message>
int normal_bits_of(const Message& message) {
    constexpr int default_bits = 8;
    if (!message.has_normal_bits()) return default_bits;
    const auto bits = message.normal_bits();
    if (bits != 0 && (bits < 2 || bits > 16))
        throw InvalidInput(fmt::format("normal_bits is {}; it must be 0 (no normals) or 2 to 16", bits));
    return static_cast<int>(bits);
}

}  // namespace meniscus::server
