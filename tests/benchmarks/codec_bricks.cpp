// codec-bricks FRAME FILE.json: the bricks of a frame's mesh with each codec, for the viewer's benchmark of decoding.
#include <CLI/CLI.hpp>
#include <exception>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/particles/particle_file.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus {
namespace {

std::string base64(const std::vector<std::byte>& bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three = three << 8U | (i + k < bytes.size() ? std::to_integer<unsigned>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? digits[three >> (18 - 6 * k) & 63U] : '=';
    }
    return out;
}

nlohmann::json coded(const Mesh& mesh, const CodingOptions& options) {
    nlohmann::json bricks = nlohmann::json::array();
    for (std::size_t i = 0; i < mesh.bricks.size(); ++i) {
        const EncodedBrick brick = encode_brick(mesh, i, options);
        bricks.push_back({{"place", brick.coordinate},
                          {"vertices", brick.vertices},
                          {"triangles", brick.triangles},
                          {"cell_levels", base64(brick.cell_levels)},
                          {"data", base64(brick.data)}});
    }
    return bricks;
}

int run(int argc, char** argv) {
    std::string in;
    std::string out;
    Settings settings;
    settings.particle_radius = 0.025;
    CodingOptions coding;
    settings.normals = false;
    CLI::App app("The bricks of a frame's mesh with each codec.");
    app.add_option("FRAME", in, "file of particles")->required();
    app.add_option("FILE", out, "JSON")->required();
    app.add_option("--particle-radius", settings.particle_radius);
    app.add_option("--cell-size", settings.cell_size, "radii");
    app.add_flag("--normals", settings.normals);
    CLI11_PARSE(app, argc, argv);

    const auto particles = formats::read_particles(in);
    Reconstructor reconstructor(settings, {.backend = Backend::cpu, .keep_lattice = true});
    Mesh mesh;
    reconstructor.reconstruct(particles.frame(), mesh);
    nlohmann::json file{{"offset_bits", encoded_offset_bits(mesh, coding)}};
    for (const Codec codec : codecs) {
        coding.codec = codec;
        file["bricks"][std::to_string(static_cast<unsigned>(codec))] = coded(mesh, coding);
    }
    std::ofstream(out) << file;
    std::cout << mesh.triangles.size() << " triangles in " << mesh.bricks.size() << " bricks\n";
    return 0;
}

}  // namespace
}  // namespace meniscus

int main(int argc, char** argv) {
    try {
        return meniscus::run(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "codec-bricks: " << error.what() << '\n';
        return 1;
    }
}
