// Attributes for meshes of tests: a vertex's values follow from its place.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus::test {

template <class Number>
MeshAttribute attribute_of(std::string name, ElementType type, std::size_t components,
                           const std::vector<Number>& numbers) {
    MeshAttribute attribute{std::move(name), type, components, {}};
    const std::span<const std::byte> bytes = std::as_bytes(std::span(numbers));
    attribute.data.assign(bytes.begin(), bytes.end());
    return attribute;
}

template <class Number>
std::vector<Number> numbers_of(const MeshAttribute& attribute) {
    std::vector<Number> numbers(attribute.data.size() / sizeof(Number));
    std::ranges::copy(attribute.data, std::as_writable_bytes(std::span(numbers)).begin());
    return numbers;
}

/// An attribute of every form: `speed`, `velocity` and `tensor` (float32), `phase`, `color` and `paint` (uint8),
/// `charge` (int32), `id` (uint32).
void add_attributes(Mesh& mesh);

/// A request for each attribute of the mesh, float32 with these bits.
std::vector<AttributeWish> wish_for_all(const Mesh& mesh, int bits);

}  // namespace meniscus::test
