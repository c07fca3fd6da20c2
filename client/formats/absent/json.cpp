// A build without nlohmann-json.
#include "formats/bytes/byte_cursor.hpp"
#include "formats/particles/particle_readers.hpp"

namespace meniscus::formats {

Particles read_particle_json(const std::string& name, std::string_view bytes, const ReadLimits& /*limits*/) {
    ByteCursor(name, bytes).fail("this build reads no JSON: build it where nlohmann-json3-dev is installed");
}

}  // namespace meniscus::formats
