#include "formats/byte_cursor.hpp"
#include "formats/particles.hpp"

namespace meniscus::formats {

Particles read_bi4(const std::string& name, std::string_view bytes) {
    ByteCursor(name, bytes).fail("bi4 is not read yet");
}

}  // namespace meniscus::formats
