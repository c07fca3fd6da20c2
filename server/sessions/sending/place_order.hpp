// The order in which a mesh holds its bricks.
#pragma once

#include <array>
#include <compare>
#include <cstdint>

namespace meniscus::server {

/// The order by z, then y, then x.
struct PlaceOrder {
    explicit PlaceOrder(const std::array<std::int32_t, 3>& place) : z(place[2]), y(place[1]), x(place[0]) {}
    std::int32_t z, y, x;
    auto operator<=>(const PlaceOrder&) const =
        default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 means what the compiler writes here
};

}  // namespace meniscus::server
