// meniscus-bench delivery: the time of a frame from a simulator, through meniscusd, to a watcher's last byte.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks.hpp"
#include "meniscus/client/client.hpp"
#include "meniscus/codec.hpp"
#include "report.hpp"
#include "server_program.hpp"
#include "warm_runs.hpp"
#include "water.hpp"

namespace meniscus::benchmarks {
namespace {

struct DeliveryOptions {
    std::size_t particles = 64 * basin_particles;
    std::string mode{name_of(Mode::uniform)};
    std::string backend = "auto";
    double cell_size = 1.0;
    unsigned frames = 10;
    int normal_bits = 8;
    std::string program = "meniscusd";
    std::string out = "delivery-results";
};

constexpr float water_radius = 0.025F;

/// A frame's way; one at a time, so that none waits for another.
struct Delivered {
    double seconds = 0.0;  ///< from push() to the watcher's last brick
    client::FrameStatistics statistics;
};

std::vector<Delivered> deliver(const std::vector<float>& water, const DeliveryOptions& options, Codec codec) {
    const ServerProgram server(options.program, {"--backend", options.backend, "--log-level", "warning"});
    client::Client simulator(server.address());
    client::Client receiver(server.address());
    Settings settings;
    settings.particle_radius = static_cast<double>(water_radius);
    settings.cell_size = options.cell_size;
    settings.mode = by_name<Mode>(options.mode, "mode");
    const std::string session = client::new_session_id();
    simulator.create_session(session, settings);
    client::StreamOptions stream_options;
    stream_options.receive_meshes = false;
    auto stream = simulator.stream(session, stream_options);
    client::WatchOptions watch_options;
    watch_options.normal_bits = options.normal_bits;
    watch_options.codec = codec;
    auto watcher = receiver.watch(session, watch_options);
    std::vector<float> positions = water;
    std::vector<Delivered> all;
    for (unsigned i = 0; i < options.frames; ++i) {
        // By a fraction of a cell, so that no brick is as it was.
        for (float& coordinate : positions) coordinate += 0.37F * static_cast<float>(options.cell_size) * water_radius;
        ParticleFrame frame;
        frame.positions = positions;
        const auto begin = std::chrono::steady_clock::now();
        stream.push(frame, i, 0.0);
        const auto received = watcher.next();
        if (!received || received->index != i)
            throw std::runtime_error("the watcher did not get frame " + std::to_string(i));
        all.push_back(
            {std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), received->statistics});
    }
    stream.finish();
    while (stream.next()) {
    }
    return all;
}

Row row_of(const DeliveryOptions& options, Codec codec, const std::vector<Delivered>& delivered) {
    const std::vector<Delivered> warm(delivered.begin() + 1, delivered.end());
    const auto median_of = [&](const auto& value) {
        std::vector<double> values;
        values.reserve(warm.size());
        for (const Delivered& each : warm) values.push_back(value(each));
        return median(std::move(values));
    };
    Row row;
    row["codec"] = name_of(codec);
    row["particles"] = options.particles;
    row["mode"] = options.mode;
    row["backend"] = warm.back().statistics.backend;
    row["first_seconds"] = delivered[0].seconds;
    row["median_seconds"] = median_of([](const Delivered& each) { return each.seconds; });
    row["least_seconds"] = std::ranges::min(warm, {}, &Delivered::seconds).seconds;
    row["reconstruction_seconds"] = median_of([](const Delivered& each) { return each.statistics.total_seconds; });
    row["download_seconds"] = median_of([](const Delivered& each) { return each.statistics.download_seconds; });
    row["encode_seconds"] = median_of([](const Delivered& each) { return each.statistics.encode_seconds; });
    row["triangles"] = warm.back().statistics.triangles;
    row["bytes"] = warm.back().statistics.encoded_bytes;
    return row;
}

void run_delivery(const DeliveryOptions& options) {
    const std::vector<float> water = make_any_water(WaterKind::splashing, options.particles, water_radius);
    GrowingTable table(options.out, "delivery");
    for (const Codec codec : {Codec::lattice_packed, Codec::lattice_entropy, Codec::draco})
        table.add(row_of(options, codec, deliver(water, options, codec)));
    nlohmann::ordered_json summary;
    summary["frames"] = options.frames;
    summary["cell_size"] = options.cell_size;
    summary["normal_bits"] = options.normal_bits;
    table.finish(summary);
}

}  // namespace

void add_delivery(CLI::App& app) {
    auto options = std::make_shared<DeliveryOptions>();
    CLI::App& command = *app.add_subcommand(
        "delivery", "Time of a frame from a simulator, through meniscusd, to a watcher's last byte, for each codec");
    add_meniscusd_option(command, options->program);
    command.add_option("--particles", options->particles, "Of a frame of splashing water")
        ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 32U))
        ->capture_default_str();
    command.add_option("--mode", options->mode, "adaptive or uniform")->capture_default_str();
    command.add_option("--backend", options->backend, "auto, cuda or cpu")->capture_default_str();
    command.add_option("--cell-size", options->cell_size, "In particle radii")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command.add_option("--frames", options->frames, "Of which the first does not count")
        ->check(CLI::Range(2U, 100'000U))
        ->capture_default_str();
    command.add_option("--normal-bits", options->normal_bits, "Per component of a normal; 0: no normals")
        ->capture_default_str();
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    command.callback([options] { run_delivery(*options); });
}

}  // namespace meniscus::benchmarks
