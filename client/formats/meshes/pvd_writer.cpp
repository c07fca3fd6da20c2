#include "formats/meshes/pvd_writer.hpp"

#include <pugixml.hpp>
#include <sstream>
#include <string>

#include "formats/bytes/atomic_file.hpp"
#include "meniscus/number_text.hpp"

namespace meniscus::formats {
namespace {

std::string shortest(double number) {
    std::string text;
    append_shortest(text, number);
    return text;
}

}  // namespace

void write_pvd(const std::filesystem::path& path, std::span<const PvdEntry> entries) {
    const std::filesystem::path folder = std::filesystem::absolute(path).lexically_normal().parent_path();
    pugi::xml_document document;
    pugi::xml_node file = document.append_child("VTKFile");
    file.append_attribute("type") = "Collection";
    file.append_attribute("version") = "0.1";
    file.append_attribute("byte_order") = "LittleEndian";
    pugi::xml_node collection = file.append_child("Collection");
    for (const PvdEntry& entry : entries) {
        pugi::xml_node node = collection.append_child("DataSet");
        node.append_attribute("timestep") = shortest(entry.time).c_str();
        node.append_attribute("group") = "";
        node.append_attribute("part") = "0";
        const std::filesystem::path relative =
            std::filesystem::absolute(entry.file).lexically_normal().lexically_relative(folder);
        node.append_attribute("file") = relative.string().c_str();
    }
    std::ostringstream text;
    document.save(text, "  ");
    write_file(path, text.str());
}

}  // namespace meniscus::formats
