#include "formats/vtk/vtk_xml_writer.hpp"

#include <bit>
#include <string>
#include <vector>

#include "formats/bytes/base64_writer.hpp"
#include "formats/bytes/deflate.hpp"
#include "formats/bytes/scalar.hpp"

namespace meniscus::formats {
namespace {

static_assert(std::endian::native == std::endian::little, "the files are little-endian");

/// Bytes that are compressed at once: readers take one block into memory after the other.
constexpr std::size_t block_bytes = std::size_t{1} << 20;

std::string_view vtk_type_of(ElementType type) {
    switch (type) {
        case ElementType::float32:
            return "Float32";
        case ElementType::uint8:
            return "UInt8";
        case ElementType::int32:
            return "Int32";
        case ElementType::uint32:
            return "UInt32";
    }
    return {};
}

/// A header of the number of blocks, their size, that of the last one if it is smaller and their compressed sizes; then
/// the blocks, as a stream of their own.
void write_blocks(AtomicFile& file, std::string_view bytes) {
    std::vector<std::string> blocks;
    for (std::size_t at = 0; at < bytes.size(); at += block_bytes)
        blocks.push_back(deflated(bytes.substr(at, block_bytes)));
    std::string header;
    store(header, std::uint64_t{blocks.size()});
    store(header, std::uint64_t{block_bytes});
    store(header, std::uint64_t{bytes.size() % block_bytes});
    for (const std::string& block : blocks) store(header, std::uint64_t{block.size()});
    Base64Writer out(file);
    out.write(header);
    out.finish();
    for (const std::string& block : blocks) out.write(block);
    out.finish();
}

/// A header of the number of bytes, and they.
void write_plain(AtomicFile& file, std::string_view bytes) {
    std::string header;
    store(header, std::uint64_t{bytes.size()});
    Base64Writer out(file);
    out.write(header);
    out.write(bytes);
    out.finish();
}

}  // namespace

VtkXmlWriter::VtkXmlWriter(const std::filesystem::path& path, VtkXmlKind kind, VtkXmlSizes sizes,
                           VtkXmlCompression compression)
    : file_(path), kind_(kind == VtkXmlKind::poly_data ? "PolyData" : "UnstructuredGrid"), compression_(compression) {
    const std::string name(kind_);
    file_.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"" + name +
                "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"");
    if (compression_ == VtkXmlCompression::zlib) file_.write(" compressor=\"vtkZLibDataCompressor\"");
    file_.write(">\n  <" + name + ">\n    <Piece NumberOfPoints=\"" + std::to_string(sizes.points));
    file_.write(kind == VtkXmlKind::unstructured_grid
                    ? "\" NumberOfCells=\"" + std::to_string(sizes.verts + sizes.polys)
                    : "\" NumberOfVerts=\"" + std::to_string(sizes.verts) +
                          "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" + std::to_string(sizes.polys));
    file_.write("\">\n");
}

void VtkXmlWriter::begin(std::string_view element, std::string_view attributes) {
    file_.write(std::string("      <").append(element).append(attributes).append(">\n"));
}

void VtkXmlWriter::end(std::string_view element) {
    file_.write(std::string("      </").append(element).append(">\n"));
}

void VtkXmlWriter::add(std::string_view name, std::string_view type, std::size_t components, std::string_view bytes) {
    // meshio makes a matrix of what has their number, be it 1, which goes without saying.
    const std::string number =
        components == 1 ? std::string() : "\" NumberOfComponents=\"" + std::to_string(components);
    file_.write(
        std::string("        <DataArray type=\"").append(type).append("\" Name=\"").append(name).append(number) +
        "\" format=\"binary\">\n");
    compression_ == VtkXmlCompression::zlib ? write_blocks(file_, bytes) : write_plain(file_, bytes);
    file_.write("\n        </DataArray>\n");
}

void VtkXmlWriter::add(const ParticleArray& array) {
    add(array.name, vtk_type_of(array.type), array.components, bytes_of(array.data.data(), array.data.size()));
}

void VtkXmlWriter::commit() {
    file_.write(std::string("    </Piece>\n  </").append(kind_).append(">\n</VTKFile>\n"));
    file_.commit();
}

}  // namespace meniscus::formats
