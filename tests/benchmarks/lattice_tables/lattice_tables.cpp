// meniscus-bench lattice-tables: makes the constant tables of the lattice codec's entropy profile.
#include <openssl/evp.h>

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>

#include "benchmarks.hpp"
#include "formats/particles/particle_file.hpp"
#include "meniscus/error.hpp"
#include "meniscus/reconstructor.hpp"
#include "trainer.hpp"
#include "water.hpp"

namespace meniscus::benchmarks {
namespace {

struct TableOptions {
    std::vector<std::string> frames;
    std::string out = "core/codec/lattice/tables";
};

std::string sha256_of(const std::string& bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
        throw std::runtime_error("OpenSSL offers no SHA-256");
    std::string text;
    for (unsigned i = 0; i < size; ++i) {
        text += "0123456789abcdef"[digest[i] >> 4];
        text += "0123456789abcdef"[digest[i] & 15];
    }
    return text;
}

/// Cells of 0.4 radii show what large cells of smooth bodies are like: at 0.5 and 1.0 the training has too few of them.
void add_bricks(const std::vector<float>& positions, double radius, std::vector<EncodedBrick>& bricks) {
    ParticleFrame frame;
    frame.positions = positions;
    for (const Mode mode : {Mode::uniform, Mode::adaptive})
        for (const double cell_size : {0.4, 0.5, 1.0}) {
            Settings settings;
            settings.particle_radius = radius;
            settings.cell_size = cell_size;
            settings.mode = mode;
            BackendOptions options{.backend = Backend::cpu};
            options.keep_lattice = true;
            Mesh mesh;
            Reconstructor(settings, options).reconstruct(frame, mesh);
            for (std::size_t b = 0; b < mesh.bricks.size(); ++b)
                bricks.push_back(encode_brick(mesh, b, {.normal_bits = 8, .codec = Codec::lattice_packed}));
        }
}

void run_lattice_tables(const TableOptions& options) {
    std::vector<EncodedBrick> bricks;
    std::vector<std::string> trained_on;
    for (const std::string& frame : options.frames) {
        const std::size_t at = frame.rfind('@');
        if (at == std::string::npos) throw InvalidInput(frame + " has no radius: write FILE@RADIUS");
        const std::filesystem::path path = frame.substr(0, at);
        const double radius = std::stod(frame.substr(at + 1));
        add_bricks(formats::read_particles(path).positions, radius, bricks);
        std::ifstream file(path, std::ios::binary);
        trained_on.push_back(path.parent_path().filename().string() + '/' + path.filename().string() + ' ' +
                             sha256_of(std::string(std::istreambuf_iterator<char>(file), {})));
    }
    constexpr float radius = 0.025F;
    for (const WaterKind kind : {WaterKind::splashing, WaterKind::calm}) {
        const std::vector<float> positions = make_water(kind, basin_particles, radius);
        add_bricks(positions, double{radius}, bricks);
        trained_on.push_back(
            "made water, " + std::string(name_of(kind)) + ' ' +
            sha256_of({reinterpret_cast<const char*>(positions.data()), positions.size() * sizeof(float)}));
    }
    std::cout << bricks.size() << " bricks" << std::endl;
    write_tables(*train_tables(bricks), trained_on, options.out);
}

}  // namespace

void add_lattice_tables(CLI::App& app) {
    auto options = std::make_shared<TableOptions>();
    CLI::App& command = *app.add_subcommand(
        "lattice-tables", "Make the tables of the lattice codec's entropy profile from frames and generated water");
    command.add_option("FRAME", options->frames, "Particle files, each as FILE@RADIUS")->required();
    command.add_option("--out", options->out, "The folder of the numbers")->capture_default_str();
    command.callback([options] { run_lattice_tables(*options); });
}

}  // namespace meniscus::benchmarks
