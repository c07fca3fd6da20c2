#include "formats/meshes/point_writer.hpp"

#include <string>

#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/scalar.hpp"

namespace meniscus::formats {

void write_points(const std::filesystem::path& path, std::span<const Point> points,
                  const std::array<double, 3>& origin) {
    const bool wide = origin != std::array<double, 3>{};
    std::string out = "ply\nformat binary_little_endian 1.0\ncomment Meniscus: particles beside the surface\n";
    out += "element vertex " + std::to_string(points.size()) + "\n";
    for (const char* axis : {"x", "y", "z"})
        out += std::string(wide ? "property double " : "property float ") + axis + "\n";
    out += "end_header\n";
    out.reserve(out.size() + points.size_bytes() * (wide ? 2 : 1));
    for (const Point& point : points)
        for (std::size_t a = 0; a < 3; ++a)
            if (wide)
                store(out, static_cast<double>(point[a]) + origin[a]);
            else
                store(out, point[a]);
    write_file(path, out);
}

}  // namespace meniscus::formats
