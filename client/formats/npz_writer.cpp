#include "formats/npz_writer.hpp"

#include <array>

#include "formats/npy.hpp"

namespace meniscus::formats {
namespace {

std::string_view descr_of(ElementType type) {
    switch (type) {
        case ElementType::float32:
            return "<f4";
        case ElementType::uint8:
            return "|u1";
        case ElementType::int32:
            return "<i4";
        case ElementType::uint32:
            return "<u4";
    }
    return {};
}

}  // namespace

void NpzWriter::add(const std::string& name, std::string_view descr, const std::vector<std::size_t>& shape,
                    std::string_view bytes) {
    const std::string header = npy_header(descr, shape);
    zip_.add(name + ".npy", std::array{std::string_view(header), bytes});
}

void NpzWriter::add(const ParticleArray& array) {
    std::vector<std::size_t> shape{array.data.size() / array.element_bytes()};
    if (array.components > 1) shape.push_back(array.components);
    add(std::string(array.name), descr_of(array.type), shape,
        {reinterpret_cast<const char*>(array.data.data()), array.data.size()});
}

}  // namespace meniscus::formats
