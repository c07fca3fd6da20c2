#include "formats/meshes/pvd_writer.hpp"

#include <string>

#include "meniscus/number_text.hpp"

namespace meniscus::formats {
namespace {

/// The value of an attribute.
std::string quoted_in_xml(std::string_view text) {
    constexpr std::string_view special = "&<>\"\t\n\r";
    std::string out = "\"";
    for (const char c : text) {
        if (special.find(c) == std::string_view::npos)
            out += c;
        else
            out.append("&#").append(std::to_string(c)).append(";");
    }
    return out += '"';
}

}  // namespace

PvdWriter::PvdWriter(const std::filesystem::path& path) : file_(path) {
    file_.write(pvd_begin);
}

void PvdWriter::add(std::string_view time, std::size_t part, std::string_view file) {
    file_.write(std::string("    <DataSet timestep=\"")
                    .append(time)
                    .append("\" group=\"\" part=\"")
                    .append(std::to_string(part))
                    .append("\" file=")
                    .append(quoted_in_xml(file))
                    .append(" />\n"));
}

void PvdWriter::commit() {
    file_.write(pvd_end);
    file_.commit();
}

void write_pvd(const std::filesystem::path& path, std::span<const PvdEntry> entries) {
    const std::filesystem::path folder = std::filesystem::absolute(path).lexically_normal().parent_path();
    PvdWriter list(path);
    for (const PvdEntry& entry : entries) {
        std::string time;
        append_shortest(time, entry.time);
        list.add(time, 0, std::filesystem::absolute(entry.file).lexically_normal().lexically_relative(folder).string());
    }
    list.commit();
}

}  // namespace meniscus::formats
