// codec-bricks FRAME FILE.json: the bricks of a frame's mesh with each codec, for the viewer's benchmark of decoding.
#include <openssl/evp.h>

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
    std::string out((bytes.size() + 2) / 3 * 4 + 1, '\0');  // a zero at the end
    const int size =
        EVP_EncodeBlock(reinterpret_cast<unsigned char*>(out.data()),
                        reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
    out.resize(static_cast<std::size_t>(size));
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
