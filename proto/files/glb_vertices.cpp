#include "files/glb_vertices.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace meniscus::files {
namespace {

template <class Values>
std::string bytes_of(const Values& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])};
}

template <class Id>
GlbVertices ids(std::span<const std::byte> data, std::string name) {
    constexpr std::int64_t exact = 1 << 24;
    std::vector<Id> list(data.size() / sizeof(Id));
    if (!list.empty()) std::memcpy(list.data(), data.data(), list.size() * sizeof(Id));
    if (std::all_of(list.begin(), list.end(),
                    [](Id id) { return std::int64_t{id} <= exact && std::int64_t{id} >= -exact; }))
        return {std::move(name), GlbComponent::single, 1, false,
                bytes_of(std::vector<float>(list.begin(), list.end()))};
    return {std::move(name), GlbComponent::unsigned_short, 2, false, bytes_of(list)};
}

}  // namespace

GlbVertices glb_positions(std::span<const std::array<float, 3>> positions) {
    return {"POSITION", GlbComponent::single, 3, false, bytes_of(positions)};
}

GlbVertices glb_normals(std::span<const Normal> normals) {
    return {"NORMAL", GlbComponent::single, 3, false, bytes_of(normals)};
}

GlbVertices glb_attribute(std::string_view name, ElementType type, std::size_t components,
                          std::span<const std::byte> data) {
    std::string own = "_";
    for (const char c : name) own += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    switch (type) {
        case ElementType::float32:
            return {std::move(own), GlbComponent::single, components, false, bytes_of(data)};
        case ElementType::uint8:
            if (components > 1 && name == "color")
                return {"COLOR_0", GlbComponent::unsigned_byte, components, true, bytes_of(data)};
            return {std::move(own), GlbComponent::unsigned_byte, components, false, bytes_of(data)};
        case ElementType::int32:
            return ids<std::int32_t>(data, std::move(own));
        case ElementType::uint32:
            return ids<std::uint32_t>(data, std::move(own));
    }
    return {};
}

bool is_finite(const GlbVertices& vertices) {
    if (vertices.type != GlbComponent::single) return true;
    for (std::size_t i = 0; i + 4 <= vertices.bytes.size(); i += 4) {
        float value = 0.0F;
        std::memcpy(&value, vertices.bytes.data() + i, sizeof value);
        if (!std::isfinite(value)) return false;
    }
    return true;
}

}  // namespace meniscus::files
