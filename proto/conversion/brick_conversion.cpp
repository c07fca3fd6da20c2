#include "conversion/brick_conversion.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "conversion/codec_conversion.hpp"
#include "meniscus/error.hpp"

namespace meniscus::conversion {

namespace {

constexpr std::size_t part_bytes = std::size_t{1} << 20;

std::string text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void append(const std::string& more, std::vector<std::byte>& bytes) {
    const auto all = std::as_bytes(std::span(more));
    bytes.insert(bytes.end(), all.begin(), all.end());
}

}  // namespace

std::vector<v1::MeshBrick> to_wire(const EncodedBrick& brick) {
    const std::size_t count = std::max<std::size_t>(1, (brick.data.size() + part_bytes - 1) / part_bytes);
    std::vector<v1::MeshBrick> parts(count);
    for (std::size_t part = 0; part < count; ++part) {
        v1::MeshBrick& wire = parts[part];
        wire.set_x(brick.coordinate[0]);
        wire.set_y(brick.coordinate[1]);
        wire.set_z(brick.coordinate[2]);
        wire.set_vertex_count(brick.vertices);
        wire.set_triangle_count(brick.triangles);
        wire.set_codec(to_wire(brick.codec));
        if (part == 0) wire.set_cell_levels(text_of(brick.cell_levels));
        const std::size_t first = part * part_bytes;
        wire.set_data(text_of(std::span(brick.data).subspan(first, std::min(part_bytes, brick.data.size() - first))));
        wire.set_part_index(static_cast<std::uint32_t>(part));
        wire.set_part_count(static_cast<std::uint32_t>(count));
    }
    return parts;
}

void append_part(const v1::MeshBrick& part, EncodedBrick& brick) {
    if (part.part_index() == 0) {
        const auto codec = codec_by_number(static_cast<std::uint32_t>(part.codec()));
        if (!codec)
            throw InvalidInput("a brick has the codec " + std::to_string(static_cast<int>(part.codec())) +
                               ", which this version does not know; it knows " + known_codecs());
        brick = {};
        brick.coordinate = {part.x(), part.y(), part.z()};
        brick.vertices = part.vertex_count();
        brick.triangles = part.triangle_count();
        brick.codec = *codec;
        append(part.cell_levels(), brick.cell_levels);
    }
    append(part.data(), brick.data);
}

}  // namespace meniscus::conversion
