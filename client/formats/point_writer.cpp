#include "formats/point_writer.hpp"

#include <string>

#include "formats/atomic_file.hpp"
#include "formats/scalar.hpp"

namespace meniscus::formats {

void write_points(const std::filesystem::path& path, std::span<const Point> points) {
    std::string out = "ply\nformat binary_little_endian 1.0\ncomment Meniscus: particles beside the surface\n";
    out += "element vertex " + std::to_string(points.size()) + "\n";
    for (const char* axis : {"x", "y", "z"}) out += std::string("property float ") + axis + "\n";
    out += "end_header\n";
    out.reserve(out.size() + points.size_bytes());
    for (const Point& point : points)
        for (const float x : point) store(out, x);
    write_file(path, out);
}

}  // namespace meniscus::formats
