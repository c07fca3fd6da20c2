// meniscus-bench codecs: bytes and processor time of the lattice codec, against Draco on the same bricks.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <numbers>

#include "benchmarks.hpp"
#include "formats/particles/particle_file.hpp"
#include "lattice_tables/trainer.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh_hash.hpp"
#include "meniscus/mesh_normals.hpp"
#include "meniscus/reconstructor.hpp"
#include "processor_time.hpp"
#include "report.hpp"
#include "warm_runs.hpp"

namespace meniscus::benchmarks {
namespace {

struct CodecOptions {
    std::vector<std::string> frames;
    double particle_radius = 0.025;
    std::vector<double> cell_sizes{0.5};
    std::vector<int> normal_bits{0, 8};
    unsigned rounds = 9;
    bool sections = false;
    bool receiver_normals = false;
    std::string out = "tests/benchmarks/results";
};

double seconds_of(const auto& work) {
    const double start = thread_seconds();
    work();
    return thread_seconds() - start;
}

struct CodecRun {
    CodingOptions options;
    BrickScratch scratch;
    std::vector<EncodedBrick> bricks;
    std::vector<double> encoding, decoding;  ///< seconds, by round

    CodecRun(Codec codec, int normal_bits) : options{.normal_bits = normal_bits, .codec = codec} {}
    void encode(const Mesh& mesh) {
        bricks.clear();
        for (std::size_t b = 0; b < mesh.bricks.size(); ++b)
            bricks.push_back(PreparedBrick(mesh, b, options, scratch).encode());
    }
    std::vector<DecodedBrick> decode(const Mesh& mesh) const {
        std::vector<DecodedBrick> decoded;
        decoded.reserve(bricks.size());
        for (const EncodedBrick& brick : bricks) decoded.push_back(decode_brick(brick, mesh.offset_bits));
        return decoded;
    }
    std::size_t bytes() const {
        std::size_t sum = 0;
        for (const EncodedBrick& brick : bricks) sum += brick.data.size() + brick.cell_levels.size();
        return sum;
    }
};

Rows measure(const Mesh& mesh, const Row& about, int normal_bits, unsigned rounds) {
    std::array<CodecRun, 3> runs{CodecRun(Codec::draco, normal_bits), CodecRun(Codec::lattice_packed, normal_bits),
                                 CodecRun(Codec::lattice_entropy, normal_bits)};
    // The first round finds the memory.
    for (unsigned round = 0; round <= rounds; ++round)
        for (CodecRun& run : runs) {
            const double encoding = seconds_of([&] { run.encode(mesh); });
            const double decoding = seconds_of([&] { (void)run.decode(mesh); });
            if (round == 0) continue;
            run.encoding.push_back(encoding);
            run.decoding.push_back(decoding);
        }
    const auto triangles = static_cast<double>(mesh.triangles.size());
    Rows rows = Rows::array();
    for (const CodecRun& run : runs) {
        if (mesh_sha256(weld_bricks(run.decode(mesh), mesh.cell_size, mesh.offset_bits)) != mesh_sha256(mesh))
            throw std::runtime_error("a mesh has come back as another one through " +
                                     std::string(name_of(run.options.codec)));
        // Ratios within a round: what slows one codec down slows the others.
        std::vector<double> encoding, decoding;
        for (std::size_t i = 0; i < run.encoding.size(); ++i) {
            encoding.push_back(runs[0].encoding[i] / run.encoding[i]);
            decoding.push_back(runs[0].decoding[i] / run.decoding[i]);
        }
        Row row = about;
        row["triangles"] = mesh.triangles.size();
        row["bricks"] = mesh.bricks.size();
        row["normal_bits"] = normal_bits;
        row["codec"] = name_of(run.options.codec);
        row["bits_per_triangle"] = 8.0 * static_cast<double>(run.bytes()) / triangles;
        row["encode_nanoseconds_per_triangle"] = 1e9 * median(run.encoding) / triangles;
        row["encode_times_draco"] = median(encoding);
        row["decode_nanoseconds_per_triangle"] = 1e9 * median(run.decoding) / triangles;
        row["decode_times_draco"] = median(decoding);
        rows.push_back(row);
    }
    return rows;
}

void print_codec(const Row& row) {
    const auto number = [&row](const char* name) { return row[name].get<double>(); };
    std::cout << std::left << std::setw(20) << row["frame"].get<std::string>().substr(0, 19) << std::setw(9)
              << row["mode"].get<std::string>() << std::right << std::setw(5) << number("cell_size") << std::setw(8)
              << row["normal_bits"].get<int>() << "  " << std::left << std::setw(8) << row["codec"].get<std::string>()
              << std::right << std::fixed << std::setprecision(2) << std::setw(10) << number("bits_per_triangle")
              << std::setprecision(1) << std::setw(12) << number("encode_nanoseconds_per_triangle")
              << std::setprecision(2) << std::setw(8) << number("encode_times_draco") << std::setprecision(1)
              << std::setw(12) << number("decode_nanoseconds_per_triangle") << std::setprecision(2) << std::setw(8)
              << number("decode_times_draco") << std::defaultfloat << std::endl;
}

/// The keeping of the lattice counts as reconstruction: what it takes is told here.
double keeping_seconds(const ParticleFrame& frame, const Settings& settings, unsigned rounds) {
    std::array<std::vector<double>, 2> seconds;
    std::array<std::unique_ptr<Reconstructor>, 2> reconstructors;
    Mesh mesh;
    for (std::size_t keeps = 0; keeps < 2; ++keeps) {
        BackendOptions options{.backend = Backend::cpu, .threads = 1};
        options.keep_lattice = keeps == 1;
        reconstructors[keeps] = std::make_unique<Reconstructor>(settings, options);
        reconstructors[keeps]->reconstruct(frame, mesh);
    }
    for (unsigned round = 0; round < rounds; ++round)
        for (std::size_t keeps = 0; keeps < 2; ++keeps)
            seconds[keeps].push_back(seconds_of([&] { reconstructors[keeps]->reconstruct(frame, mesh); }));
    return median(seconds[1]) - median(seconds[0]);
}

void print_sections(const Mesh& mesh) {
    CodecRun run(Codec::lattice_packed, 8);
    run.encode(mesh);
    std::cout << "  bits a triangle by table:";
    for (const auto& [table, bits] : bits_by_table(run.bricks))
        std::cout << ' ' << table << ' ' << std::fixed << std::setprecision(3)
                  << bits / static_cast<double>(mesh.triangles.size());
    std::cout << std::defaultfloat << std::endl;
}

/// Of --normals-by receiver: how far its normals are from those of the field, what they save, and what they take.
void print_receiver_normals(const Mesh& mesh, unsigned rounds) {
    Mesh own = mesh;
    std::vector<double> seconds;
    for (unsigned round = 0; round < rounds; ++round) seconds.push_back(seconds_of([&] { compute_normals(own); }));
    std::vector<double> degrees;
    for (std::size_t v = 0; v < own.normals.size(); ++v) {
        const auto& [ax, ay, az] = mesh.normals[v];
        const auto& [bx, by, bz] = own.normals[v];
        const double cosine = double{ax} * bx + double{ay} * by + double{az} * bz;
        const double sine = std::hypot(double{ay} * bz - double{az} * by, double{az} * bx - double{ax} * bz,
                                       double{ax} * by - double{ay} * bx);
        degrees.push_back(std::atan2(sine, cosine) * 180.0 / std::numbers::pi);
    }
    std::ranges::sort(degrees);
    const auto triangles = static_cast<double>(mesh.triangles.size());
    const auto bits = [&](int normal_bits) {
        CodecRun run(Codec::lattice_entropy, normal_bits);
        run.encode(mesh);
        return 8.0 * static_cast<double>(run.bytes()) / triangles;
    };
    std::cout << "  the receiver's normals: " << std::fixed << std::setprecision(2) << degrees[degrees.size() / 2]
              << " degrees off (median), " << degrees[degrees.size() * 99 / 100] << " (99 %); entropy " << bits(8)
              << " to " << bits(0) << " bits a triangle; " << std::setprecision(1) << 1e9 * median(seconds) / triangles
              << " ns a triangle" << std::defaultfloat << std::endl;
}

void run_codecs(const CodecOptions& options) {
    std::cout
        << "frame               mode     cell  normals  codec     bits/tri.   encode ns       x   decode ns       x\n";
    Rows rows = Rows::array();
    for (const std::string& name : options.frames) {
        const std::vector<float> positions = formats::read_particles(name).positions;
        ParticleFrame frame;
        frame.positions = positions;
        for (const double cell_size : options.cell_sizes)
            for (const Mode mode : {Mode::adaptive, Mode::uniform}) {
                Settings settings;
                settings.particle_radius = options.particle_radius;
                settings.cell_size = cell_size;
                settings.mode = mode;
                BackendOptions place{.backend = Backend::cpu, .threads = 1};
                place.keep_lattice = true;
                Mesh mesh;
                Reconstructor(settings, place).reconstruct(frame, mesh);
                if (mesh.triangles.empty()) throw InvalidInput(name + " has no surface to encode");
                Row about;
                about["frame"] = std::filesystem::path(name).stem().string();
                about["mode"] = name_of(mode);
                about["cell_size"] = cell_size;
                about["keep_lattice_nanoseconds_per_triangle"] =
                    1e9 * keeping_seconds(frame, settings, options.rounds) / static_cast<double>(mesh.triangles.size());
                for (const int bits : options.normal_bits)
                    for (const Row& row : measure(mesh, about, bits, options.rounds)) {
                        print_codec(row);
                        rows.push_back(row);
                    }
                if (options.sections) print_sections(mesh);
                if (options.receiver_normals) print_receiver_normals(mesh, options.rounds);
            }
    }
    nlohmann::ordered_json summary;
    summary["runs"] = "one thread, processor time, the codecs in turn; medians of " + std::to_string(options.rounds);
    write_report(options.out, "codecs", summary, rows);
}

}  // namespace

void add_codecs(CLI::App& app) {
    auto options = std::make_shared<CodecOptions>();
    CLI::App& command =
        *app.add_subcommand("codecs", "The lattice codec beside Draco: bits per triangle, encoding, decoding");
    command.add_option("FRAME", options->frames, "Particle files")->required();
    command.add_option("--particle-radius", options->particle_radius, "World units")->capture_default_str();
    command.add_option("--cell-size", options->cell_sizes, "In particle radii")->capture_default_str();
    command.add_option("--normal-bits", options->normal_bits, "Per component of a normal; 0: no normals")
        ->capture_default_str();
    command.add_option("--rounds", options->rounds, "Of which the median counts")
        ->check(CLI::Range(1U, 1000U))
        ->capture_default_str();
    command.add_flag("--sections", options->sections, "Print the bits of each of the entropy profile's tables, too");
    command.add_flag("--receiver-normals", options->receiver_normals,
                     "Print how far normals that a receiver computes are from the field's, what they save and take");
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    command.callback([options] { run_codecs(*options); });
}

}  // namespace meniscus::benchmarks
