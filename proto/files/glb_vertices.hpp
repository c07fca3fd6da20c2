// The values that vertices carry, in glTF's form.
//
// An attribute NAME is `_NAME`, uint8 colors are COLOR_0. glTF has no 32-bit integers at vertices: ids are float32
// where that holds all of them exactly, otherwise two uint16, the low one first.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "meniscus/element_type.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus::files {

enum class GlbComponent { unsigned_byte = 5121, unsigned_short = 5123, unsigned_int = 5125, single = 5126 };

/// Numbers of the vertices.
struct GlbVertices {
    std::string name;  ///< the attribute's name in glTF
    GlbComponent type = GlbComponent::single;
    std::size_t components = 3;
    bool normalized = false;
    std::string bytes{};  ///< the values, without gaps between the vertices

    std::size_t component_bytes() const {
        return type == GlbComponent::unsigned_byte ? 1 : type == GlbComponent::unsigned_short ? 2 : 4;
    }
    std::size_t vertex_bytes() const { return components * component_bytes(); }
};

GlbVertices glb_positions(std::span<const std::array<float, 3>> positions);
GlbVertices glb_normals(std::span<const Normal> normals);
/// data: `components` of `type` for each vertex, in the machine's byte order.
GlbVertices glb_attribute(std::string_view name, ElementType type, std::size_t components,
                          std::span<const std::byte> data);

/// glTF knows neither infinities nor not-a-numbers. Whether all are finite.
bool is_finite(const GlbVertices& vertices);

}  // namespace meniscus::files
