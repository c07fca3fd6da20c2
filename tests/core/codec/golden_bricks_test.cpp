// Bricks whose bytes and contents are kept in golden_bricks.json, which the viewer's tests read, too: neither the
// encoder nor one of the two decoders can change unseen. After a change that is wanted, MENISCUS_WRITE_GOLDEN=1 writes
// the file anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "base/instruction_set.hpp"
#include "meniscus/meniscus.hpp"
#include "support/mesh_attributes.hpp"
#include "support/particles.hpp"

namespace meniscus {
namespace {

using nlohmann::ordered_json;

const std::string path = MENISCUS_GOLDEN_BRICKS;

struct Scene {
    std::string name;
    Settings settings;
    test::Particles particles;
    CodingOptions options;
    std::size_t brick;  ///< index among the mesh's bricks
    std::vector<AttributeWish> wishes{};
};

/// Every setting is written out, so that no default changes the bricks.
Settings settings() {
    Settings s;
    s.particle_radius = 0.125;
    s.smoothing_length = 2.0;
    s.cell_size = 1.0;
    s.iso = 0.6;
    s.field = Field::color;
    s.mode = Mode::adaptive;
    s.criterion = CurvatureCriterion{.tolerance = 0.6};
    s.edge_points = Interpolation{};
    s.normals = true;
    return s;
}

/// Particles of level 3, eight times as large as those of level 0: a surface that is coarse but for the place where a
/// small one sits on it.
test::Particles large_and_small(float z = 2.0F) {
    test::Particles particles;
    particles.add(2.0F, 2.0F, z);
    particles.levels.push_back(3);
    particles.add(2.0F, 2.0F, z + 1.5F);
    particles.levels.push_back(0);
    return particles;
}

test::Particles two_drops() {
    test::Particles particles;
    particles.add(1.0F, 1.0F, 1.0F);
    particles.add(1.125F, 1.0F, 1.25F);
    return particles;
}

/// A block of particles as dense as water.
test::Particles block() {
    test::Particles particles;
    constexpr std::array places{1.0F, 1.25F, 1.5F};
    for (const float z : places)
        for (const float y : places)
            for (const float x : places) particles.add(x, y, z);
    return particles;
}

std::vector<Scene> scenes() {
    Settings bisected = settings();
    bisected.edge_points = Bisection{.steps = 7};
    bisected.normals = false;
    Settings uniform = settings();
    uniform.mode = Mode::uniform;
    uniform.field = Field::density;
    uniform.cell_size = 1.5;
    return {
        {"levels and cracks, normals of 8 bits", settings(), large_and_small(), {}, 0},
        {"8 offset bits, without normals", bisected, two_drops(), {}, 0},
        {"rounded to 2 offset bits, normals of 10 bits", uniform, block(), {.normal_bits = 10, .position_bits = 2}, 0},
        {"rounded to 4 offset bits", settings(), large_and_small(), {.position_bits = 4}, 0},
        {"attributes of every form, float32 of 8, of 12 bits and exactly",
         settings(),
         two_drops(),
         {},
         0,
         {{"speed", 12}, {"velocity", 8}, {"tensor", 0}, {"phase"}, {"color"}, {"paint"}, {"charge"}, {"id"}}},
        {"levels and cracks on a brick's face, normals of 11 bits",
         settings(),
         large_and_small(6.5F),
         {.normal_bits = 11},
         0},
        {"one bit, without normals", bisected, two_drops(), {}, 0, {{"velocity", 1}}},
    };
}

/// What a scene is called with a codec.
std::string name_with(const Scene& scene, Codec codec) {
    switch (codec) {
        case Codec::draco:
            return scene.name;
        case Codec::lattice_packed:
            return "packed: " + scene.name;
        case Codec::lattice_entropy:
            return "entropy: " + scene.name;
    }
    return {};
}

std::string hexadecimal(const std::vector<std::byte>& bytes) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string out;
    for (const std::byte byte : bytes) {
        out += digits[std::to_integer<std::size_t>(byte) >> 4U];
        out += digits[std::to_integer<std::size_t>(byte) & 15U];
    }
    return out;
}

std::vector<std::byte> from_hexadecimal(const std::string& digits) {
    std::vector<std::byte> bytes(digits.size() / 2);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::byte>(std::stoi(digits.substr(2 * i, 2), nullptr, 16));
    return bytes;
}

template <class Number>
ordered_json numbers(const MeshAttribute& attribute, const std::vector<std::uint32_t>& order) {
    const std::vector<Number> all = test::numbers_of<Number>(attribute);
    ordered_json out = ordered_json::array();
    for (const std::uint32_t v : order)
        for (std::size_t c = 0; c < attribute.components; ++c) out.push_back(all[v * attribute.components + c]);
    return out;
}

ordered_json values(const MeshAttribute& attribute, const std::vector<std::uint32_t>& order) {
    switch (attribute.type) {
        case ElementType::float32:
            return numbers<float>(attribute, order);
        case ElementType::uint8:
            return numbers<std::uint8_t>(attribute, order);
        case ElementType::int32:
            return numbers<std::int32_t>(attribute, order);
        case ElementType::uint32:
            return numbers<std::uint32_t>(attribute, order);
    }
    return {};
}

ordered_json announced(const CodedAttribute& form) {
    ordered_json out{
        {"name", form.name}, {"type", name_of(form.type)}, {"components", form.components}, {"bits", form.bits}};
    for (std::size_t c = 0; form.bits != 0 && c < form.components; ++c) {
        out["coded_minimum"].push_back(form.minimum[c]);
        out["coded_maximum"].push_back(form.maximum[c]);
    }
    return out;
}

CodedAttribute announced(const ordered_json& json) {
    CodedAttribute form;
    form.name = json.at("name");
    for (const ElementType type : choices<ElementType>)
        if (name_of(type) == json.at("type")) form.type = type;
    form.components = json.at("components");
    form.bits = json.at("bits");
    for (std::size_t c = 0; form.bits != 0 && c < form.components; ++c) {
        form.minimum[c] = json.at("coded_minimum").at(c);
        form.maximum[c] = json.at("coded_maximum").at(c);
    }
    return form;
}

/// The result of decoding the brick, in an order of its own: vertices ascending, triangles by their least vertex.
ordered_json contents(const DecodedBrick& brick, std::uint32_t offset_bits) {
    std::vector<std::uint32_t> order(brick.vertices.size());
    for (std::uint32_t v = 0; v < order.size(); ++v) order[v] = v;
    std::ranges::sort(order, {}, [&](std::uint32_t v) { return brick.vertices[v]; });
    std::vector<std::uint32_t> place(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;

    ordered_json vertices = ordered_json::array();
    ordered_json normals = ordered_json::array();
    for (const std::uint32_t v : order) {
        std::array<std::int32_t, 3> local = brick.vertices[v];
        for (std::size_t axis = 0; axis < 3; ++axis)
            local[axis] -= brick.coordinate[axis] * (brick_cells << offset_bits);
        vertices.push_back(local);
        if (brick.normals.empty()) continue;
        std::array<long, 3> normal{};
        for (std::size_t axis = 0; axis < 3; ++axis) normal[axis] = std::lround(brick.normals[v][axis] * 32767.0F);
        normals.push_back(normal);
    }
    std::vector<std::array<std::uint32_t, 4>> triangles;
    for (std::size_t t = 0; t < brick.triangles.size(); ++t) {
        Triangle triangle = brick.triangles[t];
        for (std::uint32_t& v : triangle) v = place[v];
        std::rotate(triangle.begin(), std::ranges::min_element(triangle), triangle.end());
        triangles.push_back({triangle[0], triangle[1], triangle[2], level_byte(brick.levels[t])});
    }
    std::ranges::sort(triangles);
    ordered_json out{{"vertices", vertices}, {"normals", normals}, {"triangles", triangles}};
    for (const MeshAttribute& attribute : brick.attributes) out["attribute_values"].push_back(values(attribute, order));
    return out;
}

ordered_json golden(const Scene& scene, Codec codec) {
    Reconstructor reconstructor(scene.settings, {.backend = Backend::cpu, .threads = 1, .keep_lattice = true});
    Mesh mesh;
    reconstructor.reconstruct(scene.particles.frame(), mesh);
    test::add_attributes(mesh);
    CodingOptions options = scene.options;
    options.codec = codec;
    options.attributes = coded_attributes(mesh, attribute_ranges(mesh), scene.wishes);
    const std::uint32_t offset_bits = encoded_offset_bits(mesh, options);
    const EncodedBrick brick = encode_brick(mesh, scene.brick, options);
    ordered_json out{{"name", name_with(scene, codec)},
                     {"offset_bits", offset_bits},
                     {"place", brick.coordinate},
                     {"vertex_count", brick.vertices},
                     {"triangle_count", brick.triangles},
                     {"codec", static_cast<std::uint32_t>(brick.codec)},
                     {"cell_levels", hexadecimal(brick.cell_levels)},
                     {"data", hexadecimal(brick.data)}};
    for (const CodedAttribute& form : options.attributes) out["attributes"].push_back(announced(form));
    out.update(contents(decode_brick(brick, offset_bits, options.attributes), offset_bits));
    return out;
}

ordered_json today() {
    ordered_json out{{"base_cell_size", base_cell_size},   {"brick_base_cells", brick_base_cells},
                     {"brick_cells", brick_cells},         {"max_brick_triangles", max_brick_triangles},
                     {"min_offset_bits", min_offset_bits}, {"max_offset_bits", max_offset_bits}};
    for (const Codec codec : codecs) out["codecs"].push_back(static_cast<std::uint32_t>(codec));
    for (const Codec codec : {Codec::draco, Codec::lattice_packed, Codec::lattice_entropy})
        for (const Scene& scene : scenes()) out["bricks"].push_back(golden(scene, codec));
    return out;
}

ordered_json kept() {
    std::ifstream file(path);
    return ordered_json::parse(file);
}

TEST(GoldenBricks, HaveTheBytesThatTheyHad) {
    const ordered_json now = today();
    if (std::getenv("MENISCUS_WRITE_GOLDEN") != nullptr) std::ofstream(path) << now.dump() << '\n';
    const ordered_json before = kept();
    ASSERT_EQ(before.at("bricks").size(), now.at("bricks").size());
    for (std::size_t i = 0; i < now.at("bricks").size(); ++i)
        EXPECT_EQ(before["bricks"][i].dump(), now["bricks"][i].dump()) << now["bricks"][i]["name"];
    EXPECT_EQ(before, now);
}

TEST(GoldenBricks, OfTheLatticeAreTheSameWithEveryInstructionSet) {
    const ordered_json before = kept();
    std::size_t compared = 0;
    for (const InstructionSet set : usable_instruction_sets()) {
        ASSERT_EQ(setenv("MENISCUS_INSTRUCTIONS", std::string(name_of(set)).c_str(), 1), 0);
        // A thread keeps its coder.
        std::thread([&] {
            const ordered_json all = today();
            for (const ordered_json& now : all.at("bricks")) {
                if (codec_by_number(now.at("codec")) == Codec::draco) continue;
                const auto same = std::ranges::find(before.at("bricks"), now.at("name"),
                                                    [](const ordered_json& brick) { return brick.at("name"); });
                ASSERT_NE(same, before.at("bricks").end()) << now.at("name");
                EXPECT_EQ(same->dump(), now.dump()) << now.at("name") << ' ' << name_of(set);
                ++compared;
            }
        }).join();
    }
    unsetenv("MENISCUS_INSTRUCTIONS");
    EXPECT_EQ(compared, 2 * scenes().size() * usable_instruction_sets().size());
}

TEST(GoldenBricks, AreDecodedToTheContentsThatTheyHad) {
    const ordered_json all = kept();
    for (const ordered_json& brick : all.at("bricks")) {
        EncodedBrick encoded;
        encoded.coordinate = brick.at("place");
        encoded.vertices = brick.at("vertex_count");
        encoded.triangles = brick.at("triangle_count");
        encoded.codec = codec_by_number(brick.at("codec")).value();
        encoded.cell_levels = from_hexadecimal(brick.at("cell_levels"));
        encoded.data = from_hexadecimal(brick.at("data"));
        const std::uint32_t offset_bits = brick.at("offset_bits");
        std::vector<CodedAttribute> attributes;
        for (const ordered_json& json : brick.value("attributes", ordered_json::array()))
            attributes.push_back(announced(json));
        const ordered_json decoded = contents(decode_brick(encoded, offset_bits, attributes), offset_bits);
        for (const char* part : {"vertices", "normals", "triangles", "attribute_values"})
            EXPECT_EQ(decoded.value(part, ordered_json()), brick.value(part, ordered_json()))
                << brick.at("name") << ' ' << part;
    }
}

TEST(GoldenBricks, HaveTrianglesOfEveryLevelAndCracks) {
    std::array<bool, triangle_level_count> seen{};
    const ordered_json all = kept();
    for (const ordered_json& brick : all.at("bricks"))
        for (const ordered_json& triangle : brick.at("triangles")) seen.at(triangle.at(3).get<std::size_t>()) = true;
    EXPECT_EQ(seen, (std::array{true, true, true, true}));
}

}  // namespace
}  // namespace meniscus
