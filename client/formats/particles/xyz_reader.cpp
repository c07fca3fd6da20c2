#include <bit>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/particles/particle_readers.hpp"

namespace meniscus::formats {
namespace {

/// Whether the bytes are numbers as people write them. Float32 of such bytes alone are of about 1e-19 to 1e-4, or of
/// 1e22.
bool is_text(std::string_view bytes) {
    const std::string_view begin = bytes.substr(0, 256);
    return !begin.empty() && begin.find_first_not_of("0123456789+-.eE,; \t\r\n") == std::string_view::npos;
}

}  // namespace

Particles read_xyz(const std::string& name, std::string_view bytes, const ReadLimits& /*limits*/) {
    constexpr std::size_t particle_bytes = 3 * sizeof(float);
    if (is_text(bytes))
        ByteCursor(name, bytes)
            .fail("it is text; .xyz, .bin and .raw are raw float32 triples (in Python, numpy.save() makes a .npy)");
    if (bytes.size() % particle_bytes != 0)
        ByteCursor(name, bytes)
            .fail("its size is " + std::to_string(bytes.size()) + " bytes, not a multiple of " +
                  std::to_string(particle_bytes) + " (three float32 per particle)");
    Particles particles;
    particles.positions.resize(bytes.size() / sizeof(float));
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
        particles.positions[i] = load<float>(bytes.data() + i * sizeof(float), std::endian::little);
    return particles;
}

}  // namespace meniscus::formats
