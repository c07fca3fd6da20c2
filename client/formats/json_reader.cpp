#include "formats/byte_cursor.hpp"
#include "formats/particles.hpp"

namespace meniscus::formats {

Particles read_particle_json(const std::string& name, std::string_view bytes) {
    ByteCursor(name, bytes).fail("JSON is not read yet");
}

}  // namespace meniscus::formats
