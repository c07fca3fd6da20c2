#include "formats/vtk/legacy_vtk_arrays.hpp"

#include <bit>
#include <string_view>

#include "formats/bytes/scalar.hpp"

namespace meniscus::formats {
namespace {

std::string_view legacy_type_of(ElementType type) {
    switch (type) {
        case ElementType::float32:
            return "float";
        case ElementType::uint8:
            return "unsigned_char";
        case ElementType::int32:
            return "int";
        case ElementType::uint32:
            return "unsigned_int";
    }
    return {};
}

}  // namespace

std::string vtk_field(std::span<const ParticleArray> arrays, std::size_t points) {
    if (arrays.empty()) return {};
    std::string out = "FIELD FieldData " + std::to_string(arrays.size()) + "\n";
    for (const ParticleArray& array : arrays) {
        out += array.name;
        for (const std::size_t number : {array.components, points}) out.append(" ").append(std::to_string(number));
        out.append(" ").append(legacy_type_of(array.type)).append("\n");
        const std::size_t size = meniscus::size_of(array.type);
        const auto* bytes = reinterpret_cast<const char*>(array.data.data());
        for (std::size_t at = 0; at < array.data.size(); at += size) {
            if (size == 1)
                out += bytes[at];
            else
                store(out, load<std::uint32_t>(bytes + at, std::endian::native), std::endian::big);
        }
        out += '\n';
    }
    return out;
}

}  // namespace meniscus::formats
