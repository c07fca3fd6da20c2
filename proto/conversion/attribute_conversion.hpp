// Attributes of vertices on the wire and in core.
#pragma once

#include <google/protobuf/repeated_ptr_field.h>

#include <span>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/element_type.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/v1/mesh.pb.h"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::conversion {

v1::AttributeType attribute_type(ElementType type);
/// Throws InvalidInput, with the number, for one that this version does not know, or that no attribute has.
ElementType from_wire(v1::AttributeType type);
v1::ElementType element_type(ElementType type);
/// Likewise.
ElementType from_wire(v1::ElementType type);

using AttributeWishes = google::protobuf::RepeatedPtrField<v1::AttributeWish>;

/// Throws InvalidInput for more than max_particle_arrays, for one that comes twice, and for names and bits that no
/// attribute has.
std::vector<AttributeWish> attribute_wishes(const AttributeWishes& wire);
/// Throws likewise.
AttributeWishes to_wire(std::span<const AttributeWish> wishes);

/// Announces one attribute. form: its name, type and components. range: null for a mesh without vertices. coded: null
/// unless the bricks carry it.
void announce(const MeshAttribute& form, const AttributeRange* range, const CodedAttribute* coded,
              v1::MeshBegin& message);
/// Announces all attributes of the mesh. ranges: attribute_ranges() of it. coded: those that the bricks carry.
void to_wire(const Mesh& mesh, std::span<const AttributeRange> ranges, std::span<const CodedAttribute> coded,
             v1::MeshBegin& message);

/// The attributes that the bricks carry. Throws InvalidInput unless all that the message announces can be of a mesh.
std::vector<CodedAttribute> coded_attributes(const v1::MeshBegin& message);

}  // namespace meniscus::conversion
