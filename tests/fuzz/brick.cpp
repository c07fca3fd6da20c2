#include <algorithm>

#include "meniscus/names.hpp"
#include "meniscus/particle_frame.hpp"
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

void decode(Front& front, const std::vector<CodedAttribute>& attributes, Codec codec = Codec::draco) {
    const std::uint32_t offset_bits = front.number(1);
    EncodedBrick encoded;
    encoded.codec = codec;
    encoded.vertices = front.number(4);
    encoded.triangles = front.number(4);
    encoded.cell_levels = to_vector(front.piece(front.number(4)));
    encoded.data = to_vector(front.rest());
    may_refuse([&] {
        const DecodedBrick decoded = decode_brick(encoded, offset_bits, attributes);
        require(decoded.vertices.size() == encoded.vertices, "as many vertices as announced");
        require(decoded.triangles.size() == encoded.triangles, "as many triangles as announced");
        require(decoded.levels.size() == encoded.triangles, "a level for each triangle");
        for (const Triangle& triangle : decoded.triangles)
            for (const std::uint32_t vertex : triangle)
                require(vertex < encoded.vertices, "triangles name vertices that are there");
        require(decoded.attributes.size() == attributes.size(), "the attributes that were announced");
        for (const MeshAttribute& attribute : decoded.attributes)
            require(attribute.data.size() == encoded.vertices * attribute.element_bytes(), "a value for each vertex");
    });
}

std::string bytes_of(const Mesh& mesh, std::size_t place, const CodingOptions& options) {
    const EncodedBrick encoded = encode_brick(mesh, place, options);
    return number_bytes(encoded_offset_bits(mesh, options), 1) + number_bytes(encoded.vertices, 4) +
           number_bytes(encoded.triangles, 4) +
           number_bytes(static_cast<std::uint32_t>(encoded.cell_levels.size()), 4) + to_string(encoded.cell_levels) +
           to_string(encoded.data);
}

}  // namespace

void brick(Bytes bytes) {
    Front front(bytes);
    decode(front, {});
}

Seeds brick_seeds() {
    const Mesh mesh = sample_mesh();
    Seeds seeds;
    for (const int normal_bits : {0, 8})
        for (std::size_t i = 0; i < mesh.bricks.size(); ++i)
            seeds.push_back(bytes_of(mesh, i, {.normal_bits = normal_bits}));
    return seeds;
}

/// With normals and without, on the mesh's lattice and on a coarser one.
Seeds lattice_seeds(Codec codec) {
    const Mesh mesh = sample_mesh();
    Seeds seeds;
    for (const int normal_bits : {0, 8, 11})
        for (const int position_bits : {0, 4})
            for (std::size_t i = 0; i < mesh.bricks.size(); ++i)
                seeds.push_back(
                    bytes_of(mesh, i, {.normal_bits = normal_bits, .position_bits = position_bits, .codec = codec}));
    return seeds;
}

void lattice_packed(Bytes bytes) {
    Front front(bytes);
    decode(front, {}, Codec::lattice_packed);
}
Seeds lattice_packed_seeds() {
    return lattice_seeds(Codec::lattice_packed);
}

void lattice_entropy(Bytes bytes) {
    Front front(bytes);
    decode(front, {}, Codec::lattice_entropy);
}
Seeds lattice_entropy_seeds() {
    return lattice_seeds(Codec::lattice_entropy);
}

void brick_with_attributes(Bytes bytes) {
    Front front(bytes);
    std::vector<CodedAttribute> attributes(front.number(1) % (max_particle_arrays + 1));
    for (CodedAttribute& attribute : attributes) {
        attribute.name = "attribute";
        attribute.type = static_cast<ElementType>(front.number(1) % choices<ElementType>.size());
        attribute.components = front.number(1);
        attribute.bits = static_cast<int>(front.number(1));
        attribute.minimum.fill(-3.0F);
        attribute.maximum.fill(5.0F);
    }
    decode(front, attributes);
}

Seeds brick_with_attributes_seeds() {
    const Mesh mesh = sample_mesh(true);
    Seeds seeds;
    for (const int bits : {0, 8, 12}) {
        const AttributeWish all{"", bits};
        CodingOptions options;
        options.attributes = coded_attributes(mesh, attribute_ranges(mesh), {&all, 1});
        std::string forms = number_bytes(static_cast<std::uint32_t>(options.attributes.size()), 1);
        for (const CodedAttribute& attribute : options.attributes)
            forms += number_bytes(static_cast<std::uint32_t>(attribute.type), 1) +
                     number_bytes(static_cast<std::uint32_t>(attribute.components), 1) +
                     number_bytes(static_cast<std::uint32_t>(attribute.bits), 1);
        seeds.push_back(forms + bytes_of(mesh, 0, options));
    }
    return seeds;
}

}  // namespace meniscus::fuzz
