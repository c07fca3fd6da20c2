// What a publisher says of a frame before its bricks come.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/statistics.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::server {

/// All bricks of a frame, or those of one part of it.
struct BrickPart {
    std::size_t bytes = 0;  ///< of the messages that carry bricks and spray
    std::uint64_t bricks = 0;
    std::uint64_t triangles = 0;
    std::uint64_t spray_points = 0;
    std::vector<CodedAttribute> attributes;  ///< all that the surface has, as the bricks carry them
    std::vector<AttributeRange> ranges;      ///< of each attribute; none without vertices
    Statistics statistics;
};

/// Throws InvalidInput for what cannot be of a surface of these settings.
BrickPart brick_part(const v1::PublishBegin& message, const Settings& settings);

/// The part whose attributes are those of the frame: the first one with bricks; of a frame without bricks the first one
/// that names any.
const BrickPart& lead_of(std::span<const BrickPart> parts);

/// Throws InvalidInput, with the number of the part, for one with bricks that cannot be in one frame with the lead.
void require_same_surface(std::span<const BrickPart> parts);

/// The ranges of attributes over all parts; none if no part has vertices.
std::vector<AttributeRange> joint_ranges(std::span<const BrickPart> parts);

/// Sums of counts, of bytes and of volumes, the longest of the seconds, each warning once.
Statistics joint_statistics(std::span<const BrickPart> parts);

}  // namespace meniscus::server
