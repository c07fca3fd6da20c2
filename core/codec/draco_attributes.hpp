// Attributes of vertices as generic attributes of a Draco mesh.
#pragma once

#include <draco/attributes/point_attribute.h>
#include <draco/mesh/mesh.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "meniscus/attribute_coding.hpp"

namespace meniscus {

/// The attribute with this place in the list has the unique id first_attribute_id + place.
inline constexpr std::uint32_t first_attribute_id = 16;

/// coded: coded_bytes() for each vertex.
void add_draco_attribute(draco::Mesh& mesh, std::size_t place, const CodedAttribute& form,
                         std::span<const std::byte> coded);

/// The misfit of the mesh's attributes, in words, empty if there is none. They must be positions, normals or none, and
/// the announced ones; their values need not be there yet.
std::string misfit(const draco::PointCloud& mesh, std::span<const CodedAttribute> announced);

/// coded_bytes() for each of these points. Throws InvalidInput for a point that names a value that is not there. The
/// mesh has no misfit.
std::vector<std::byte> draco_attribute(const draco::Mesh& mesh, std::size_t place, const CodedAttribute& form,
                                       std::span<const std::uint32_t> points);

}  // namespace meniscus
