#include "files/glb_container.hpp"

#include <cstdint>
#include <limits>

#include "meniscus/error.hpp"

namespace meniscus::files {
namespace {

constexpr std::size_t header_bytes = 12;
constexpr std::size_t chunk_header_bytes = 8;

void append(std::string& out, std::uint32_t number) {
    for (int byte = 0; byte < 4; ++byte) out += static_cast<char>(number >> (8 * byte) & 0xFF);
}

void append_chunk(std::string& out, std::string_view content, std::uint32_t type, char padding) {
    append(out, static_cast<std::uint32_t>(glb_aligned(content.size())));
    append(out, type);
    out += content;
    out.append(glb_aligned(content.size()) - content.size(), padding);
}

}  // namespace

std::string glb_container(std::string_view json, std::string_view buffer) {
    constexpr std::uint32_t magic = 0x46546C67, version = 2, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
    const std::size_t bytes = header_bytes + chunk_header_bytes + glb_aligned(json.size()) +
                              (buffer.empty() ? 0 : chunk_header_bytes + glb_aligned(buffer.size()));
    if (bytes > std::numeric_limits<std::uint32_t>::max())
        throw LimitExceeded("a GLB file of " + std::to_string(bytes) +
                            " bytes; the format holds at most 4294967295: use another format, or a larger cell size");
    std::string out;
    out.reserve(bytes);
    append(out, magic);
    append(out, version);
    append(out, static_cast<std::uint32_t>(bytes));
    append_chunk(out, json, json_chunk, ' ');
    if (!buffer.empty()) append_chunk(out, buffer, binary_chunk, '\0');
    return out;
}

}  // namespace meniscus::files
