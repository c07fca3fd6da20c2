#include "support/mesh_attributes.hpp"

#include <cstdint>

namespace meniscus::test {

namespace {

/// All bits of them differ from vertex to vertex.
std::uint32_t mixed(const LatticePosition& p, std::uint32_t component) {
    std::uint32_t bits = 0x9E3779B9U * (component + 1);
    for (const std::int32_t x : p) bits = (bits ^ static_cast<std::uint32_t>(x)) * 0x85EBCA6BU;
    return bits ^ (bits >> 15);
}

template <class Number, class Function>
MeshAttribute from_places(const Mesh& mesh, const char* name, ElementType type, std::uint32_t components,
                          Function&& number) {
    std::vector<Number> numbers;
    for (const LatticePosition& p : mesh.vertices)
        for (std::uint32_t c = 0; c < components; ++c) numbers.push_back(static_cast<Number>(number(p, c)));
    return attribute_of(name, type, components, numbers);
}

}  // namespace

void add_attributes(Mesh& mesh) {
    // Exact in float32, whatever the machine.
    const auto smooth = [](const LatticePosition& p, std::uint32_t c) {
        return static_cast<float>(p[c % 3] - 2 * p[(c + 1) % 3]) / 64.0F + static_cast<float>(c);
    };
    const auto add = [&](MeshAttribute attribute) { mesh.attributes.push_back(std::move(attribute)); };
    add(from_places<float>(mesh, "speed", ElementType::float32, 1, smooth));
    add(from_places<float>(mesh, "velocity", ElementType::float32, 3, smooth));
    add(from_places<float>(mesh, "tensor", ElementType::float32, 4, smooth));
    add(from_places<std::uint8_t>(mesh, "phase", ElementType::uint8, 1, mixed));
    add(from_places<std::uint8_t>(mesh, "color", ElementType::uint8, 3, mixed));
    add(from_places<std::uint8_t>(mesh, "paint", ElementType::uint8, 4, mixed));
    add(from_places<std::int32_t>(mesh, "charge", ElementType::int32, 1, mixed));
    add(from_places<std::uint32_t>(mesh, "id", ElementType::uint32, 1, mixed));
}

std::vector<AttributeWish> wish_for_all(const Mesh& mesh, int bits) {
    std::vector<AttributeWish> wishes;
    for (const MeshAttribute& attribute : mesh.attributes) wishes.push_back({attribute.name, bits});
    return wishes;
}

}  // namespace meniscus::test
