// VTK's XML, polygonal data or an unstructured grid: arrays as base64, each within its element.
//
// Not appended behind the XML, though that is smaller by a quarter: expat 2.6, and Debian's 2.5.0-1+deb12u2, put off
// looking at what may be half a token (CVE-2023-52425). VTK of that time stops them at the underscore too late, so that
// raw bytes are refused as no XML: Debian's ParaView opens no file with appended data, its own neither.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "formats/bytes/atomic_file.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus::formats {

enum class VtkXmlCompression { none, zlib };

enum class VtkXmlKind { poly_data, unstructured_grid };

/// Points and cells of a file.
struct VtkXmlSizes {
    std::size_t points = 0;
    std::size_t verts = 0;
    std::size_t polys = 0;
};

/// Writes a file with one piece, atomically: what it was given, once commit() has been called. Arrays go to the file at
/// once; of a compressed one its compressed form is kept till then.
class VtkXmlWriter {
public:
    VtkXmlWriter(const std::filesystem::path& path, VtkXmlKind kind, VtkXmlSizes sizes, VtkXmlCompression compression);

    /// Begins an element of arrays: "Points", "PointData", "CellData", "Verts", "Polys", "Cells". attributes: of it, ""
    /// or " Normals=\"Normals\"".
    void begin(std::string_view element, std::string_view attributes = {});
    /// An array in it. type: VTK's, "Float32". bytes: little-endian.
    void add(std::string_view name, std::string_view type, std::size_t components, std::string_view bytes);
    void add(const ParticleArray& array);
    void end(std::string_view element);

    void commit();

private:
    AtomicFile file_;
    std::string_view kind_;  ///< VTK's name of it
    VtkXmlCompression compression_;
};

}  // namespace meniscus::formats
