// meniscus-bench encoding: Draco by bricks, against the whole mesh in one piece.
#include <CLI/CLI.hpp>
#include <chrono>
#include <iomanip>
#include <iostream>
#include <memory>

#include "benchmarks.hpp"
#include "formats/particles/particle_file.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/error.hpp"
#include "meniscus/reconstructor.hpp"
#include "one_piece.hpp"
#include "report.hpp"
#include "warm_runs.hpp"
#include "water.hpp"

namespace meniscus::benchmarks {
namespace {

struct EncodingOptions {
    std::string in;
    double particle_radius = 0.025;
    std::string water{name_of(WaterKind::splashing)};
    std::size_t particles = 16 * basin_particles;
    double cell_size = Settings{}.cell_size;
    std::vector<int> speeds{10, 7, 5, 0};
    std::vector<int> normal_bits{0, 8};
    unsigned repeats = 3;
    std::string out = "tests/benchmarks/results";
};

struct EncodedSize {
    std::size_t draco = 0;   ///< bytes
    std::size_t levels = 0;  ///< bytes
};

EncodedSize encode_bricks(const Mesh& mesh, const CodingOptions& options) {
    EncodedSize size;
    for (std::size_t i = 0; i < mesh.bricks.size(); ++i) {
        const EncodedBrick brick = encode_brick(mesh, i, options);
        size.draco += brick.data.size();
        size.levels += brick.cell_levels.size();
    }
    return size;
}

/// Median seconds of `work`.
double measure_seconds(unsigned repeats, const auto& work) {
    std::vector<double> seconds;
    for (unsigned i = 0; i < repeats; ++i) {
        const auto start = std::chrono::steady_clock::now();
        work();
        seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return median(std::move(seconds));
}

Row measure(const Mesh& mesh, const std::string& mode, const CodingOptions& coding, unsigned repeats) {
    EncodedSize bricks;
    std::size_t one_piece = 0;
    const double brick_seconds = measure_seconds(repeats, [&] { bricks = encode_bricks(mesh, coding); });
    const double one_piece_seconds = measure_seconds(repeats, [&] { one_piece = encode_in_one_piece(mesh, coding); });
    const auto triangles = static_cast<double>(mesh.triangles.size());
    const auto bits = [triangles](std::size_t bytes) { return 8.0 * static_cast<double>(bytes) / triangles; };
    Row row;
    row["mode"] = mode;
    row["speed"] = coding.speed;
    row["normal_bits"] = coding.normal_bits;
    row["triangles"] = mesh.triangles.size();
    row["bricks"] = mesh.bricks.size();
    row["bricks_triangles_per_second"] = triangles / brick_seconds;
    row["bricks_bits_per_triangle"] = bits(bricks.draco);
    row["level_bits_per_triangle"] = bits(bricks.levels);
    row["one_piece_triangles_per_second"] = triangles / one_piece_seconds;
    row["one_piece_bits_per_triangle"] = bits(one_piece);
    row["bricks_over_one_piece_bytes"] = static_cast<double>(bricks.draco) / static_cast<double>(one_piece);
    return row;
}

void print(const Row& row) {
    const auto number = [&row](const char* name) { return row[name].get<double>(); };
    std::cout << std::left << std::setw(9) << row["mode"].get<std::string>() << std::right << std::fixed
              << std::setprecision(2) << std::setw(6) << row["speed"].get<int>() << std::setw(8)
              << row["normal_bits"].get<int>() << std::setw(13) << 1e-6 * number("bricks_triangles_per_second")
              << std::setw(11) << number("bricks_bits_per_triangle") << std::setw(9)
              << number("level_bits_per_triangle") << std::setw(16) << 1e-6 * number("one_piece_triangles_per_second")
              << std::setw(10) << number("one_piece_bits_per_triangle") << std::setprecision(1) << std::setw(10)
              << 100.0 * (number("bricks_over_one_piece_bytes") - 1.0) << " %" << std::defaultfloat << std::endl;
}

void run_encoding(const EncodingOptions& options) {
    const WaterKind kind = by_name<WaterKind>(options.water, "water");
    const std::vector<float> positions =
        options.in.empty() ? make_water(kind, options.particles, static_cast<float>(options.particle_radius))
                           : formats::read_particles(options.in).positions;
    ParticleFrame frame;
    frame.positions = positions;
    Settings settings;
    settings.particle_radius = options.particle_radius;
    settings.cell_size = options.cell_size;
    std::cout << "mode     speed normals bricks Mtri/s  bits/tri.   levels one piece Mtri/s bits/tri.  overhead\n";
    Rows rows = Rows::array();
    for (const Mode mode : {Mode::uniform, Mode::adaptive}) {
        settings.mode = mode;
        Mesh mesh;
        Reconstructor(settings).reconstruct(frame, mesh);
        if (mesh.triangles.empty())
            throw InvalidInput("there is no surface to encode: " + std::to_string(frame.count()) + " particles");
        for (const int speed : options.speeds)
            for (const int bits : options.normal_bits) {
                rows.push_back(
                    measure(mesh, std::string(name_of(mode)), {.normal_bits = bits, .speed = speed}, options.repeats));
                print(rows.back());
            }
    }
    nlohmann::ordered_json summary;
    summary["runs"] = "one thread; median of " + std::to_string(options.repeats);
    summary["input"] =
        options.in.empty() ? std::string(name_of(kind)) : std::filesystem::path(options.in).filename().string();
    summary["particles"] = frame.count();
    summary["cell_size"] = options.cell_size;
    write_report(options.out, "encoding", summary, rows);
}

}  // namespace

void add_encoding(CLI::App& app) {
    auto options = std::make_shared<EncodingOptions>();
    CLI::App& command =
        *app.add_subcommand("encoding", "Draco by bricks: speed, bits per triangle, overhead against one piece");
    command.add_option("IN", options->in, "Particles; without it water is generated");
    command.add_option("--particle-radius", options->particle_radius, "World units")->capture_default_str();
    command.add_option("--water", options->water, "Generated water: " + listed(names<WaterKind>))
        ->capture_default_str();
    command.add_option("--particles", options->particles, "Of generated water")->capture_default_str();
    command.add_option("--cell-size", options->cell_size, "In particle radii")->capture_default_str();
    command.add_option("--speed", options->speeds, "Draco's speeds, 0 to 10")->capture_default_str();
    command.add_option("--normal-bits", options->normal_bits, "Per component of a normal; 0: no normals")
        ->capture_default_str();
    command.add_option("--repeats", options->repeats, "Runs of each case, of which the median counts")
        ->check(CLI::Range(1U, 1000U))
        ->capture_default_str();
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    command.callback([options] { run_encoding(*options); });
}

}  // namespace meniscus::benchmarks
