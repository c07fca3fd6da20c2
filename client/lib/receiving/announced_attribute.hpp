// An attribute as a message announces it.
#pragma once

#include <algorithm>

#include "conversion/attribute_conversion.hpp"
#include "meniscus/client/received_frame.hpp"
#include "meniscus/v1/mesh.pb.h"

namespace meniscus::client {

/// wire: of a message that conversion::coded_attributes() accepts.
inline FrameAttribute announced_attribute(const v1::MeshAttribute& wire) {
    FrameAttribute attribute{
        .name = wire.name(), .type = conversion::from_wire(wire.type()), .components = wire.components()};
    if (wire.minimum_size() == 0) return attribute;
    AttributeRange& range = attribute.range.emplace();
    std::ranges::copy(wire.minimum(), range.minimum.begin());
    std::ranges::copy(wire.maximum(), range.maximum.begin());
    return attribute;
}

}  // namespace meniscus::client
