// A build without HDF5.
#include "formats/bytes/byte_cursor.hpp"
#include "formats/particles/particle_readers.hpp"

namespace meniscus::formats {

Particles read_hdf5(const std::string& name, std::string_view bytes, const ReadLimits& /*limits*/) {
    ByteCursor(name, bytes).fail("this build reads no HDF5: build it where libhdf5-dev is installed");
}

}  // namespace meniscus::formats
