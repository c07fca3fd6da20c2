// meniscus-bench surfaces: processor time of meniscusd for surfaces that are made elsewhere, against reconstructing
// them.
#include <CLI/CLI.hpp>
#include <iomanip>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks.hpp"
#include "meniscus/client/client.hpp"
#include "meniscus/reconstructor.hpp"
#include "moving_frames.hpp"
#include "report.hpp"
#include "server_program.hpp"
#include "warm_runs.hpp"
#include "water.hpp"

namespace meniscus::benchmarks {
namespace {

struct SurfacesOptions {
    std::vector<std::size_t> particles{basin_particles, 16 * basin_particles};
    double cell_size = 1.0;
    unsigned frames = 20;
    unsigned repeats = 5;
    std::string program = "meniscusd";
    std::string out = "tests/benchmarks/results";
};

constexpr double radius = 0.025;

/// The surfaces of the frames, packed, as their maker sends them.
std::vector<client::ReceivedFrame> surfaces_of(const Frames& frames, const Settings& settings) {
    BackendOptions backend{.backend = Backend::cpu};
    backend.keep_lattice = true;
    Reconstructor reconstructor(settings, backend);
    Mesh mesh;
    std::vector<client::ReceivedFrame> surfaces;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        reconstructor.reconstruct(frame_of(frames[i]), mesh);
        surfaces.push_back(
            client::encode_frame(mesh, reconstructor.statistics(), i, 0.0, {.codec = Codec::lattice_packed}));
    }
    return surfaces;
}

/// Processor time of a frame in meniscusd, seconds. push: sends the frame of that number, and waits for its answer. A
/// watcher takes each mesh, packed; the first half of the frames warms up.
template <class Upload>
double processor_seconds_of(const ServerProgram& server, client::Watcher& watcher, std::size_t frames,
                            const Upload& upload) {
    const std::size_t warming_up = frames / 2;
    double before = 0.0;
    for (std::size_t i = 0; i < frames; ++i) {
        if (i == warming_up) before = server.processor_seconds();
        upload(i);
        const auto frame = watcher.next();
        if (!frame || frame->index != i) throw std::runtime_error("the watcher has skipped a frame");
    }
    return (server.processor_seconds() - before) / static_cast<double>(frames - warming_up);
}

struct Seconds {
    double reconstructed;
    double published;
    double checked;
};

Seconds measure_once(const Frames& frames, const std::vector<client::ReceivedFrame>& surfaces, const Settings& settings,
                     const std::string& program) {
    const auto run = [&](const std::vector<std::string>& more, bool publishes) {
        std::vector<std::string> flags{"--threads", "1", "--backend", "cpu", "--log-level", "warning"};
        flags.insert(flags.end(), more.begin(), more.end());
        const ServerProgram server(program, flags);
        client::Client client(server.address());
        const std::string session = client::new_session_id();
        client.create_session(session, settings);
        client::WatchOptions watch;
        watch.codec = Codec::lattice_packed;
        auto watcher = client.watch(session, watch);
        if (!publishes) {
            auto stream = client.stream(session, {.receive_meshes = false});
            return processor_seconds_of(server, watcher, frames.size(), [&](std::size_t i) {
                stream.push(frame_of(frames[i]), i, 0.0);
                if (!stream.next()) throw std::runtime_error("the stream has ended");
            });
        }
        auto publisher = client.publish(session);
        return processor_seconds_of(server, watcher, frames.size(), [&](std::size_t i) {
            publisher.push(surfaces[i]);
            if (!publisher.next()) throw std::runtime_error("the publisher has ended");
        });
    };
    return {.reconstructed = run({}, false), .published = run({}, true), .checked = run({"--check-published"}, true)};
}

Row measure(const std::vector<float>& water, const SurfacesOptions& options) {
    Settings settings;
    settings.particle_radius = radius;
    settings.cell_size = options.cell_size;
    const Frames frames = moving(water, settings, options.frames);
    const std::vector<client::ReceivedFrame> surfaces = surfaces_of(frames, settings);
    std::vector<double> reconstructed;
    std::vector<double> published;
    std::vector<double> checked;
    std::vector<double> ratios;
    std::vector<double> checked_ratios;
    for (unsigned i = 0; i < options.repeats; ++i) {  // in turn, so that all see the same machine
        const Seconds seconds = measure_once(frames, surfaces, settings, options.program);
        reconstructed.push_back(seconds.reconstructed);
        published.push_back(seconds.published);
        checked.push_back(seconds.checked);
        ratios.push_back(seconds.published / seconds.reconstructed);
        checked_ratios.push_back(seconds.checked / seconds.reconstructed);
    }
    Row row;
    row["particles"] = water.size() / 3;
    row["reconstructed_processor_seconds"] = median(reconstructed);
    row["published_processor_seconds"] = median(published);
    row["checked_processor_seconds"] = median(checked);
    row["published_over_reconstructed"] = median(ratios);
    row["checked_over_reconstructed"] = median(checked_ratios);
    return row;
}

void run_surfaces(const SurfacesOptions& options) {
    std::cout << "particles   ms of a frame: reconstructed   published   and checked   ratio   and checked\n"
              << std::fixed;
    Rows rows = Rows::array();
    for (const std::size_t particles : options.particles) {
        const Row row = measure(make_water(WaterKind::splashing, particles, static_cast<float>(radius)), options);
        const auto number = [&row](const char* name) { return row[name].get<double>(); };
        std::cout << std::setw(9) << row["particles"].get<std::size_t>() << std::setprecision(2) << std::setw(31)
                  << 1e3 * number("reconstructed_processor_seconds") << std::setw(12)
                  << 1e3 * number("published_processor_seconds") << std::setw(14)
                  << 1e3 * number("checked_processor_seconds") << std::setprecision(3) << std::setw(8)
                  << number("published_over_reconstructed") << std::setw(14) << number("checked_over_reconstructed")
                  << std::endl;
        rows.push_back(row);
    }
    nlohmann::ordered_json summary;
    summary["runs"] =
        "meniscusd with one worker thread, a watcher of packed meshes; no brick is twice the same; medians "
        "of " +
        std::to_string(options.repeats) + " runs in turn";
    summary["cell_size"] = options.cell_size;
    summary["frames"] = options.frames;
    write_report(options.out, "surfaces", summary, rows);
}

}  // namespace

void add_surfaces(CLI::App& app) {
    auto options = std::make_shared<SurfacesOptions>();
    CLI::App& command = *app.add_subcommand(
        "surfaces", "Processor time of meniscusd for surfaces that are made elsewhere, against reconstructing them");
    command.add_option("--particles", options->particles, "Of a frame")->capture_default_str();
    command.add_option("--cell-size", options->cell_size, "In radii")->capture_default_str();
    command.add_option("--frames", options->frames, "Of a run, of which the second half counts")
        ->check(CLI::Range(2U, 100'000U))
        ->capture_default_str();
    command.add_option("--repeats", options->repeats, "Runs, of which the median counts")
        ->check(CLI::Range(1U, 1000U))
        ->capture_default_str();
    add_meniscusd_option(command, options->program);
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    command.callback([options] { run_surfaces(*options); });
}

}  // namespace meniscus::benchmarks
