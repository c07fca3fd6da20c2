#include "formats/containers/ply_properties.hpp"

#include <array>
#include <bit>
#include <string_view>

#include "formats/containers/named_values.hpp"

namespace meniscus::formats {
namespace {

static_assert(std::endian::native == std::endian::little, "the files are little-endian");

std::string_view ply_type_of(ElementType type) {
    switch (type) {
        case ElementType::float32:
            return "float";
        case ElementType::uint8:
            return "uchar";
        case ElementType::int32:
            return "int";
        case ElementType::uint32:
            return "uint";
    }
    return {};
}

std::string property_name(const ParticleArray& array, std::size_t component) {
    static constexpr std::array<std::string_view, 4> colors{"red", "green", "blue", "alpha"};
    static constexpr std::array<std::string_view, 4> axes{"_x", "_y", "_z", "_w"};
    if (array.components == 1) return name_beside({"x", "y", "z", "nx", "ny", "nz", "level"}, array.name);
    if (array.name == "color" && array.type == ElementType::uint8 && array.components <= colors.size())
        return std::string(colors[component]);
    return std::string(array.name).append(axes[component]);
}

}  // namespace

std::string ply_properties(std::span<const ParticleArray> arrays) {
    std::string out;
    for (const ParticleArray& array : arrays)
        for (std::size_t component = 0; component < array.components; ++component)
            out.append("property ")
                .append(ply_type_of(array.type))
                .append(" ")
                .append(property_name(array, component)) += '\n';
    return out;
}

}  // namespace meniscus::formats
