#include "formats/particles/particle_writer.hpp"

#include <bit>
#include <numeric>
#include <string>
#include <vector>

#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/scalar.hpp"
#include "formats/containers/named_values.hpp"
#include "formats/containers/npz_writer.hpp"
#include "formats/containers/ply_properties.hpp"
#include "formats/vtk/vtk_xml_writer.hpp"

namespace meniscus::formats {

void write_particle_ply(const std::filesystem::path& path, const ParticleFrame& frame) {
    const std::size_t count = frame.count();
    std::string out = "ply\nformat binary_little_endian 1.0\ncomment Meniscus: particles\nelement vertex " +
                      std::to_string(count) + "\n";
    for (const char* axis : {"x", "y", "z"}) out += std::string("property float ") + axis + "\n";
    if (!frame.levels.empty()) out += "property uchar level\n";
    out += ply_properties(frame.arrays) + "end_header\n";
    AtomicFile file(path);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) store(out, frame.positions[3 * i + axis]);
        if (!frame.levels.empty()) out += static_cast<char>(frame.levels[i]);
        for (const ParticleArray& array : frame.arrays) append_element(out, array, i);
        file.write(out);
        out.clear();
    }
    file.write(out);
    file.commit();
}

void write_particle_vtp(const std::filesystem::path& path, const ParticleFrame& frame) {
    const std::size_t count = frame.count();
    VtkXmlWriter out(path, VtkXmlKind::poly_data, {.points = count, .verts = count}, VtkXmlCompression::none);
    out.begin("PointData");
    for (const ParticleArray& array : with_levels(frame, "level")) out.add(array);
    out.end("PointData");
    out.begin("Points");
    out.add("Points", "Float32", 3, bytes_of(frame.positions.data(), frame.positions.size()));
    out.end("Points");
    std::vector<std::int64_t> numbers(count);
    out.begin("Verts");
    std::iota(numbers.begin(), numbers.end(), 0);
    out.add("connectivity", "Int64", 1, bytes_of(numbers.data(), count));
    std::iota(numbers.begin(), numbers.end(), 1);
    out.add("offsets", "Int64", 1, bytes_of(numbers.data(), count));
    out.end("Verts");
    out.commit();
}

void write_particle_npz(const std::filesystem::path& path, const ParticleFrame& frame) {
    NpzWriter out(path);
    out.add("positions", "<f4", {frame.count(), 3}, bytes_of(frame.positions.data(), frame.positions.size()));
    if (!frame.levels.empty()) out.add({"levels", std::as_bytes(frame.levels), ElementType::uint8, 1});
    for (const ParticleArray& array : frame.arrays) {
        const std::string name = name_beside({"positions", "levels", "level", "x", "y", "z", "triangles"}, array.name);
        out.add({name, array.data, array.type, array.components});
    }
    out.commit();
}

}  // namespace meniscus::formats
