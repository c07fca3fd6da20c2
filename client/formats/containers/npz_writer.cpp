#include "formats/containers/npz_writer.hpp"

#include <array>

#include "formats/containers/npy.hpp"

namespace meniscus::formats {
void NpzWriter::add(const std::string& name, std::string_view descr, const std::vector<std::size_t>& shape,
                    std::string_view bytes) {
    const std::string header = npy_header(descr, shape);
    zip_.add(name + ".npy", std::array{std::string_view(header), bytes});
}

void NpzWriter::add(const ParticleArray& array) {
    std::vector<std::size_t> shape{array.data.size() / array.element_bytes()};
    if (array.components > 1) shape.push_back(array.components);
    add(std::string(array.name), npy_name_of(array.type), shape,
        {reinterpret_cast<const char*>(array.data.data()), array.data.size()});
}

}  // namespace meniscus::formats
