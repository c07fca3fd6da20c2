// meniscus-bench service: processor time of meniscusd for each codec, against that of reconstructing and encoding the
// same frames here.
#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <future>
#include <iomanip>
#include <iostream>
#include <memory>

#include "backend_options.hpp"
#include "benchmarks.hpp"
#include "formats/particles/particle_file.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/client/client.hpp"
#include "meniscus/reconstructor.hpp"
#include "moving_frames.hpp"
#include "report.hpp"
#include "server_program.hpp"
#include "warm_runs.hpp"
#include "water.hpp"

namespace meniscus::benchmarks {
namespace {

struct ServiceOptions {
    std::vector<std::size_t> particles{basin_particles, 16 * basin_particles};
    std::string frame;  ///< a particle file in place of generated water
    double particle_radius = 0.025;
    std::string mode{name_of(Mode::adaptive)};
    double cell_size = 1.0;
    unsigned frames = 20;
    unsigned repeats = 5;
    int normal_bits = 8;
    std::string program = "meniscusd";
    std::string out = "tests/benchmarks/results";
};

/// Processor time of one frame in this process, seconds: one thread reconstructs while another one encodes the frame
/// before. Two cores may be one core's two threads, and each then takes more processor time than alone: as in the
/// server, so that the two compare.
double processor_seconds_here(const Frames& frames, const Settings& settings, const CodingOptions& coding) {
    BackendOptions place = one_cpu_thread;
    place.keep_lattice = needs_lattice(coding.codec);
    Reconstructor reconstructor(settings, place);
    std::array<Mesh, 2> meshes;
    const auto run = [&] {
        std::future<void> encoding;
        for (std::size_t i = 0; i < frames.size(); ++i) {
            Mesh& mesh = meshes[i % 2];
            reconstructor.reconstruct(frame_of(frames[i]), mesh);
            if (encoding.valid()) encoding.get();
            encoding = std::async(std::launch::async, [&mesh, &coding] {
                for (std::size_t brick = 0; brick < mesh.bricks.size(); ++brick) encode_brick(mesh, brick, coding);
            });
        }
        encoding.get();
    };
    run();  // warm
    const double before = processor_seconds();
    run();
    return (processor_seconds() - before) / static_cast<double>(frames.size());
}

void stream_frames(client::Client& client, const std::string& session, const Frames& frames,
                   const CodingOptions& coding) {
    client::StreamOptions stream_options;
    stream_options.normal_bits = coding.normal_bits;
    stream_options.codec = coding.codec;
    auto stream = client.stream(session, stream_options);
    for (std::size_t i = 0; i < frames.size(); ++i) stream.push(frame_of(frames[i]), i, 0.0);
    stream.finish();
    while (stream.next()) {
    }
}

/// Processor time of one frame in meniscusd, seconds.
double processor_seconds_served(const Frames& frames, const Settings& settings, const CodingOptions& coding,
                                const std::string& program) {
    const ServerProgram server(program, {"--threads", "1", "--backend", "cpu", "--log-level", "warning"});
    client::Client client(server.address());
    const std::string session = client::new_session_id();
    client.create_session(session, settings);
    stream_frames(client, session, frames, coding);  // warm
    const double before = server.processor_seconds();
    stream_frames(client, session, frames, coding);
    return (server.processor_seconds() - before) / static_cast<double>(frames.size());
}

/// A row for each codec.
Rows measure(const std::vector<float>& water, const ServiceOptions& options) {
    Settings settings;
    settings.particle_radius = options.particle_radius;
    settings.mode = by_name<Mode>(options.mode, "mode");
    settings.cell_size = options.cell_size;
    const Frames frames = moving(water, settings, options.frames);
    struct Run {
        CodingOptions coding;
        std::vector<double> here, served;
    };
    std::vector<Run> runs;
    for (const Codec codec : {Codec::draco, Codec::lattice_packed, Codec::lattice_entropy})
        runs.push_back({{.normal_bits = options.normal_bits, .codec = codec}, {}, {}});
    for (unsigned i = 0; i < options.repeats; ++i)  // in turn, so that all see the same machine
        for (Run& run : runs) {
            run.here.push_back(processor_seconds_here(frames, settings, run.coding));
            run.served.push_back(processor_seconds_served(frames, settings, run.coding, options.program));
        }
    const auto ratio = [](const std::vector<double>& of, const std::vector<double>& to) {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < of.size(); ++i) ratios.push_back(of[i] / to[i]);
        return median(std::move(ratios));
    };
    Rows rows = Rows::array();
    for (const Run& run : runs) {
        Row row;
        row["particles"] = water.size() / 3;
        row["codec"] = name_of(run.coding.codec);
        row["here_processor_seconds"] = median(run.here);
        row["served_processor_seconds"] = median(run.served);
        row["served_over_here"] = ratio(run.served, run.here);
        row["served_over_draco"] = ratio(run.served, runs[0].served);
        rows.push_back(row);
    }
    return rows;
}

void run_service(const ServiceOptions& options) {
    std::cout << "particles  codec    reconstruct + encode ms  meniscusd ms   ratio   over Draco\n" << std::fixed;
    std::vector<std::vector<float>> waters;
    if (options.frame.empty())
        for (const std::size_t particles : options.particles)
            waters.push_back(make_water(WaterKind::splashing, particles, static_cast<float>(options.particle_radius)));
    else
        waters.push_back(formats::read_particles(options.frame).positions);
    Rows rows = Rows::array();
    for (const std::vector<float>& water : waters)
        for (const Row& row : measure(water, options)) {
            const auto number = [&row](const char* name) { return row[name].get<double>(); };
            std::cout << std::setw(9) << row["particles"].get<std::size_t>() << "  " << std::left << std::setw(8)
                      << row["codec"].get<std::string>() << std::right << std::setprecision(2) << std::setw(24)
                      << 1e3 * number("here_processor_seconds") << std::setw(14)
                      << 1e3 * number("served_processor_seconds") << std::setprecision(3) << std::setw(8)
                      << number("served_over_here") << std::setw(13) << number("served_over_draco") << std::endl;
            rows.push_back(row);
        }
    nlohmann::ordered_json summary;
    summary["runs"] =
        "processor time per frame, frames overlapping, one thread reconstructs and one encodes; median of " +
        std::to_string(options.repeats) + " rounds";
    summary["input"] =
        options.frame.empty() ? "splashing water" : std::filesystem::path(options.frame).filename().string();
    summary["mode"] = options.mode;
    summary["frames"] = options.frames;
    summary["cell_size"] = options.cell_size;
    summary["normal_bits"] = options.normal_bits;
    write_report(options.out, "service", summary, rows);
}

}  // namespace

void add_service(CLI::App& app) {
    auto options = std::make_shared<ServiceOptions>();
    CLI::App& command = *app.add_subcommand("service", "Processor time that meniscusd adds to reconstruct and encode");
    add_meniscusd_option(command, options->program);
    command.add_option("--particles", options->particles, "Of a frame of splashing water")->capture_default_str();
    command.add_option("--frame", options->frame, "A particle file in place of generated water");
    command.add_option("--particle-radius", options->particle_radius, "World units")->capture_default_str();
    command.add_option("--mode", options->mode, "adaptive or uniform")->capture_default_str();
    command.add_option("--cell-size", options->cell_size, "In particle radii")->capture_default_str();
    command.add_option("--frames", options->frames, "Of a run, after as many that do not count")
        ->check(CLI::Range(1U, 100'000U))
        ->capture_default_str();
    command.add_option("--normal-bits", options->normal_bits, "Per component of a normal; 0: no normals")
        ->capture_default_str();
    command.add_option("--repeats", options->repeats, "Pairs of runs, of which the median counts")
        ->check(CLI::Range(1U, 1000U))
        ->capture_default_str();
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    command.callback([options] { run_service(*options); });
}

}  // namespace meniscus::benchmarks
