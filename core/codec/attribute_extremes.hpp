// attribute_ranges() of a mesh whose vertices stay on the device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/cuda/launch.hpp"
#include "meniscus/attribute_coding.hpp"
#include "meniscus/element_type.hpp"

namespace meniscus::cuda {

/// Of each component, in an order of unsigned numbers. Zero before; of two the greater is kept.
struct AttributeExtremes {
    std::uint32_t greatest[max_attribute_components];
    std::uint32_t least[max_attribute_components];  ///< bits inverted

    /// The extremes as numbers; there is a vertex.
    AttributeRange range(ElementType type, std::size_t components) const;
};

/// values: of the vertices, device pointer.
void find_extremes(const std::byte* values, ElementType type, std::uint32_t vertices, std::size_t components,
                   AttributeExtremes* extremes, const Launcher& launch);

}  // namespace meniscus::cuda
