// meniscus-bench publishing: processor time that meniscusd takes to publish a session, against that for one watcher.
#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "benchmarks.hpp"
#include "meniscus/client/client.hpp"
#include "moving_frames.hpp"
#include "report.hpp"
#include "server_program.hpp"
#include "warm_runs.hpp"
#include "water.hpp"

namespace meniscus::benchmarks {
namespace {

struct PublishingOptions {
    std::vector<std::size_t> particles{basin_particles, 16 * basin_particles};
    double cell_size = 1.0;
    unsigned frames = 40;
    unsigned repeats = 5;
    std::string program = "meniscusd";
    std::string out = "tests/benchmarks/results";
};

constexpr double radius = 0.025;
/// The pace of the frames, over the time of frames that follow each other at once.
constexpr int times_slower = 3;

/// The readers of a session's meshes. All have the same format: entropy codec, normals of 8 bits.
struct Readers {
    const char* name;
    bool published;
    bool watched;
};
constexpr std::array<Readers, 4> all_readers{
    {{"nobody", false, false}, {"a watcher", false, true}, {"the publication", true, false}, {"both", true, true}}};

using Clock = std::chrono::steady_clock;

/// At a pace, as a live session's, at which each frame has been taken by all before the next one comes: two threads
/// that are one core's take more processor time together. The watcher skips none.
void stream_frames(client::Stream& stream, std::optional<client::Watcher>& watcher, const Frames& frames,
                   std::uint64_t first, Clock::duration pace) {
    auto due = Clock::now();
    for (std::size_t i = 0; i < frames.size(); ++i) {
        std::this_thread::sleep_until(due);
        due += pace;
        stream.push(frame_of(frames[i]), first + i, 0.0);
        if (!stream.next()) throw std::runtime_error("the stream has ended");
        if (!watcher) continue;
        const auto frame = watcher->next();
        if (!frame || frame->index != first + i) throw std::runtime_error("the watcher has skipped a frame");
    }
}

/// Processor time of a frame in meniscusd, seconds. Its publication, whose segments end meanwhile, is not read: caches
/// read it, once for all.
double processor_seconds_with(const Readers& readers, const Frames& frames, const Settings& settings,
                              const std::string& program) {
    const ServerProgram server(program, {"--threads", "1", "--backend", "cpu", "--log-level", "warning", "--http",
                                         "127.0.0.1:0", "--publish"});
    client::Client client(server.address());
    const std::string session = client::new_session_id();
    client.create_session(session, settings, {.publish = readers.published});
    auto stream = client.stream(session, {.receive_meshes = false});
    std::optional<client::Watcher> watcher;
    if (readers.watched) {
        client::WatchOptions options;
        options.normal_bits = 8;
        options.codec = Codec::lattice_entropy;
        watcher.emplace(client.watch(session, options));
    }
    const auto began = Clock::now();
    stream_frames(stream, watcher, frames, 0, {});  // warm
    const auto pace = times_slower * (Clock::now() - began) / static_cast<Clock::rep>(frames.size());
    const double before = server.processor_seconds();
    stream_frames(stream, watcher, frames, frames.size(), pace);
    std::this_thread::sleep_for(pace);
    stream.finish();
    while (stream.next()) {
    }
    client.delete_session(session);  // with which the last segment ends
    return (server.processor_seconds() - before) / static_cast<double>(frames.size());
}

Row measure(const std::vector<float>& water, const PublishingOptions& options) {
    Settings settings;
    settings.particle_radius = radius;
    settings.cell_size = options.cell_size;
    const Frames frames = moving(water, settings, options.frames);
    std::array<std::vector<double>, all_readers.size()> seconds;
    for (unsigned i = 0; i < options.repeats; ++i)  // in turn, so that all see the same machine
        for (std::size_t r = 0; r < all_readers.size(); ++r)
            seconds[r].push_back(processor_seconds_with(all_readers[r], frames, settings, options.program));
    /// Of what one adds to another, over what a watcher adds.
    const auto over_a_watcher = [&](std::size_t with, std::size_t without) {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < options.repeats; ++i)
            ratios.push_back((seconds[with][i] - seconds[without][i]) / (seconds[1][i] - seconds[0][i]));
        return median(std::move(ratios));
    };
    Row row;
    row["particles"] = water.size() / 3;
    row["nobody_processor_seconds"] = median(seconds[0]);
    row["watcher_processor_seconds"] = median(seconds[1]);
    row["publication_processor_seconds"] = median(seconds[2]);
    row["both_processor_seconds"] = median(seconds[3]);
    row["publication_over_watcher"] = over_a_watcher(2, 0);
    row["publication_beside_a_watcher_over_watcher"] = over_a_watcher(3, 1);
    return row;
}

void run_publishing(const PublishingOptions& options) {
    std::cout << "particles   ms of a frame: nobody   watcher   publication      both   publication over watcher   "
                 "beside one\n"
              << std::fixed;
    Rows rows = Rows::array();
    for (const std::size_t particles : options.particles) {
        const Row row = measure(make_water(WaterKind::splashing, particles, static_cast<float>(radius)), options);
        const auto number = [&row](const char* name) { return row[name].get<double>(); };
        std::cout << std::setw(9) << row["particles"].get<std::size_t>() << std::setprecision(2) << std::setw(25)
                  << 1e3 * number("nobody_processor_seconds") << std::setw(10)
                  << 1e3 * number("watcher_processor_seconds") << std::setw(14)
                  << 1e3 * number("publication_processor_seconds") << std::setw(10)
                  << 1e3 * number("both_processor_seconds") << std::setprecision(3) << std::setw(27)
                  << number("publication_over_watcher") << std::setw(13)
                  << number("publication_beside_a_watcher_over_watcher") << std::endl;
        rows.push_back(row);
    }
    nlohmann::ordered_json summary;
    summary["runs"] = "processor time of meniscusd per frame, a third as fast as they could come; median of " +
                      std::to_string(options.repeats) + " rounds";
    summary["input"] = "splashing water that moves";
    summary["readers"] = "entropy codec, normals of 8 bits; the simulator takes no meshes";
    summary["frames"] = options.frames;
    summary["cell_size"] = options.cell_size;
    write_report(options.out, "publishing", summary, rows);
}

}  // namespace

void add_publishing(CLI::App& app) {
    auto options = std::make_shared<PublishingOptions>();
    CLI::App& command = *app.add_subcommand(
        "publishing", "Processor time that meniscusd adds to publish a session, against that of one watcher");
    add_meniscusd_option(command, options->program);
    command.add_option("--particles", options->particles, "Of a frame of splashing water")->capture_default_str();
    command.add_option("--cell-size", options->cell_size, "In particle radii")->capture_default_str();
    command.add_option("--frames", options->frames, "Of a run, after as many that do not count")
        ->check(CLI::Range(1U, 100'000U))
        ->capture_default_str();
    command.add_option("--repeats", options->repeats, "Rounds, of which the median counts")
        ->check(CLI::Range(1U, 1000U))
        ->capture_default_str();
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    command.callback([options] { run_publishing(*options); });
}

}  // namespace meniscus::benchmarks
