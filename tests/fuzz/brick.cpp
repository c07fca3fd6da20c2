#include <algorithm>

#include "support.hpp"

namespace meniscus::fuzz {

namespace {

std::vector<std::byte> to_vector(Bytes bytes) {
    std::vector<std::byte> out(bytes.size());
    std::transform(bytes.begin(), bytes.end(), out.begin(), [](char c) { return static_cast<std::byte>(c); });
    return out;
}

std::string to_string(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

void brick(Bytes bytes) {
    Front front(bytes);
    const std::uint32_t offset_bits = front.number(1);
    EncodedBrick encoded;
    encoded.vertices = front.number(4);
    encoded.triangles = front.number(4);
    encoded.cell_levels = to_vector(front.piece(front.number(4)));
    encoded.data = to_vector(front.rest());
    may_refuse([&] {
        const DecodedBrick decoded = decode_brick(encoded, offset_bits);
        require(decoded.vertices.size() == encoded.vertices, "as many vertices as announced");
        require(decoded.triangles.size() == encoded.triangles, "as many triangles as announced");
        require(decoded.levels.size() == encoded.triangles, "a level for each triangle");
        for (const Triangle& triangle : decoded.triangles)
            for (const std::uint32_t vertex : triangle)
                require(vertex < encoded.vertices, "triangles name vertices that are there");
    });
}

Seeds brick_seeds() {
    const Mesh mesh = sample_mesh();
    Seeds seeds;
    for (const int normal_bits : {0, 8})
        for (std::size_t i = 0; i < mesh.bricks.size(); ++i) {
            const EncodedBrick encoded = encode_brick(mesh, i, {.normal_bits = normal_bits});
            seeds.push_back(number_bytes(mesh.offset_bits, 1) + number_bytes(encoded.vertices, 4) +
                            number_bytes(encoded.triangles, 4) +
                            number_bytes(static_cast<std::uint32_t>(encoded.cell_levels.size()), 4) +
                            to_string(encoded.cell_levels) + to_string(encoded.data));
        }
    return seeds;
}

}  // namespace meniscus::fuzz
