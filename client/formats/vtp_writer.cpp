#include "formats/vtp_writer.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <vector>

#include "formats/atomic_file.hpp"
#include "formats/scalar.hpp"

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

std::string compressed(std::string_view bytes) {
    uLongf size = ::compressBound(static_cast<uLong>(bytes.size()));
    std::string out(size, '\0');
    if (::compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                    static_cast<uLong>(bytes.size()), Z_BEST_SPEED) != Z_OK)
        throw std::runtime_error("zlib does not compress " + std::to_string(bytes.size()) + " bytes");
    out.resize(size);
    return out;
}

/// The number of blocks, their size, that of the last one if it is smaller, their compressed sizes; the blocks.
void append_blocks(std::string& out, std::string_view bytes) {
    std::vector<std::string> blocks;
    for (std::size_t at = 0; at < bytes.size(); at += block_bytes)
        blocks.push_back(compressed(bytes.substr(at, block_bytes)));
    store(out, std::uint64_t{blocks.size()});
    store(out, std::uint64_t{block_bytes});
    store(out, std::uint64_t{bytes.size() % block_bytes});
    for (const std::string& block : blocks) store(out, std::uint64_t{block.size()});
    for (const std::string& block : blocks) out += block;
}

}  // namespace

void VtpWriter::begin(std::string_view element, std::string_view attributes) {
    elements_.append("      <").append(element).append(attributes).append(">\n");
}

void VtpWriter::end(std::string_view element) {
    elements_.append("      </").append(element).append(">\n");
}

void VtpWriter::add(std::string_view name, std::string_view type, std::size_t components, std::string_view bytes) {
    elements_.append("        <DataArray type=\"").append(type).append("\" Name=\"").append(name);
    elements_ += "\" NumberOfComponents=\"" + std::to_string(components) + "\" format=\"appended\" offset=\"" +
                 std::to_string(appended_.size()) + "\"/>\n";
    if (compression_ == VtpCompression::zlib) return append_blocks(appended_, bytes);
    store(appended_, std::uint64_t{bytes.size()});
    appended_ += bytes;
}

void VtpWriter::add(const ParticleArray& array) {
    add(array.name, vtk_type_of(array.type), array.components, bytes_of(array.data.data(), array.data.size()));
}

void VtpWriter::write(const std::filesystem::path& path, std::size_t points, std::size_t verts,
                      std::size_t polys) const {
    std::string head =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\"";
    if (compression_ == VtpCompression::zlib) head += " compressor=\"vtkZLibDataCompressor\"";
    head += ">\n  <PolyData>\n    <Piece NumberOfPoints=\"" + std::to_string(points) + "\" NumberOfVerts=\"" +
            std::to_string(verts) + "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
            std::to_string(polys) + "\">\n";
    AtomicFile file(path);
    file.write(head);
    file.write(elements_);
    file.write("    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_");
    file.write(appended_);
    file.write("\n  </AppendedData>\n</VTKFile>\n");
    file.commit();
}

}  // namespace meniscus::formats
