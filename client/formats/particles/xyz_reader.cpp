#include <bit>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/particles/particle_readers.hpp"

namespace meniscus::formats {

Particles read_xyz(const std::string& name, std::string_view bytes, const ReadLimits& /*limits*/) {
    constexpr std::size_t particle_bytes = 3 * sizeof(float);
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
