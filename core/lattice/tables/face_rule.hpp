// The one rule from which the cube and the crack tables follow: how the edge points of a square face are joined.
// (core/README.md#one-face-rule-two-tables)
#pragma once

#include <array>
#include <cstdint>

namespace meniscus {

/// Joins the point on the side where a walk around the face enters the inside to the point where it leaves it.
struct FaceSegment {
    int enter = 0;
    int leave = 0;
};

struct FaceSegments {
    int count = 0;
    std::array<FaceSegment, 2> segments{};
};

/// inside: the face's corners in the order of a walk; side i lies between corners i and i + 1.
/// Every run of inside corners is cut off by one segment, so that on an ambiguous face (two diagonal corners inside)
/// the inside corners are cut off one by one.
constexpr FaceSegments join_face(const std::array<bool, 4>& inside) {
    FaceSegments result;
    for (int i = 0; i < 4; ++i) {
        if (inside[static_cast<std::size_t>(i)] || !inside[static_cast<std::size_t>((i + 1) % 4)]) continue;
        int leave = (i + 1) % 4;
        while (inside[static_cast<std::size_t>((leave + 1) % 4)]) leave = (leave + 1) % 4;
        result.segments[static_cast<std::size_t>(result.count++)] = {i, leave};
    }
    return result;
}

}  // namespace meniscus
