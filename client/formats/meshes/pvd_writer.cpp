#include "formats/meshes/pvd_writer.hpp"

#include <string>
#include <string_view>

#include "formats/bytes/atomic_file.hpp"
#include "meniscus/number_text.hpp"

namespace meniscus::formats {
namespace {

/// As the value of an attribute. Names of files have any bytes.
std::string quoted_in_xml(std::string_view text) {
    constexpr std::string_view special = "&<>\"";
    std::string out = "\"";
    for (const char c : text) {
        if (special.find(c) == std::string_view::npos && static_cast<unsigned char>(c) >= ' ')
            out += c;
        else
            out.append("&#").append(std::to_string(c)).append(";");
    }
    return out += '"';
}

}  // namespace

void write_pvd(const std::filesystem::path& path, std::span<const PvdEntry> entries) {
    const std::filesystem::path folder = std::filesystem::absolute(path).lexically_normal().parent_path();
    AtomicFile file(path);
    file.write(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
        "  <Collection>\n");
    std::string line;
    for (const PvdEntry& entry : entries) {
        const std::filesystem::path relative =
            std::filesystem::absolute(entry.file).lexically_normal().lexically_relative(folder);
        line = "    <DataSet timestep=\"";
        append_shortest(line, entry.time);
        line.append("\" group=\"\" part=\"").append(std::to_string(entry.part)).append("\" file=");
        line.append(quoted_in_xml(relative.string())).append(" />\n");
        file.write(line);
    }
    file.write("  </Collection>\n</VTKFile>\n");
    file.commit();
}

}  // namespace meniscus::formats
