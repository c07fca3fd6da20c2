#include "formats/particles/vtk_writer.hpp"

#include <bit>
#include <string>

#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/containers/named_values.hpp"
#include "formats/vtk/legacy_vtk_arrays.hpp"

namespace meniscus::formats {

void write_vtk(const std::filesystem::path& path, const ParticleFrame& frame) {
    const std::size_t count = frame.count();
    const std::string n = std::to_string(count);
    std::string out =
        "# vtk DataFile Version 4.1\nMeniscus particles\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS " + n + " float\n";
    for (const float x : frame.positions) store(out, x, std::endian::big);
    out += "\nCELLS " + n + " " + std::to_string(2 * count) + "\n";
    for (std::size_t i = 0; i < count; ++i) {
        store(out, std::int32_t{1}, std::endian::big);
        store(out, static_cast<std::int32_t>(i), std::endian::big);
    }
    out += "\nCELL_TYPES " + n + "\n";
    for (std::size_t i = 0; i < count; ++i) store(out, std::int32_t{1}, std::endian::big);
    out += "\nPOINT_DATA " + n + "\n";
    out += vtk_field(with_levels(frame, "level"), count);
    write_file(path, out);
}

}  // namespace meniscus::formats
