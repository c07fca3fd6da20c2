#include "formats/byte_cursor.hpp"
#include "formats/particles.hpp"

namespace meniscus::formats {

Particles read_bgeo(const std::string& name, std::string_view bytes, const ReadLimits&) {
    ByteCursor(name, bytes).fail("BGEO is not read yet");
}

}  // namespace meniscus::formats
