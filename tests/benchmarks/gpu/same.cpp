// meniscus-bench same: the GPU's meshes are the CPU's, to the byte and in the same order, at sizes at which grids are
// full.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "backend_options.hpp"
#include "engine/cuda/launch_observer.hpp"
#include "gpu/gpu.hpp"
#include "gpu/mesh_difference.hpp"
#include "gpu/time_budget.hpp"
#include "meniscus/reconstructor.hpp"
#include "pipeline/backend.hpp"
#include "report.hpp"
#include "water.hpp"

namespace meniscus::benchmarks {
namespace {

struct SameOptions {
    std::vector<std::size_t> particles = {basin_particles, 16 * basin_particles, 64 * basin_particles,
                                          256 * basin_particles, 1024 * basin_particles};
    std::vector<double> cell_sizes = {1.0, 0.5};
    std::vector<std::string> fields = {"smooth", "color"};
    std::vector<std::string> modes = {"uniform", "adaptive"};
    std::vector<std::string> waters = {"splashing", "calm"};
    unsigned replays = 4;
    unsigned threads = 4;
    double budget = 0.0;
    std::string out = "same-results";
};

constexpr float particle_radius = 0.025F;
/// Sizes up to here run in several threads at once: full grids from a tenth of that on, and the memory of few frames.
constexpr std::size_t most_particles_in_threads = 64 * basin_particles;

struct Case {
    std::size_t particles;
    WaterKind water;
    Settings settings;

    /// A measure that its time grows with.
    double size() const { return static_cast<double>(particles) / (settings.cell_size * settings.cell_size); }
    Row row(const std::string& run) const {
        return {{"particles", particles},         {"water", name_of(water)},         {"field", name_of(settings.field)},
                {"mode", name_of(settings.mode)}, {"cell_size", settings.cell_size}, {"run", run}};
    }
};

/// Counts the graphs that this thread launches.
class GraphCounter final : public cuda::LaunchObserver {
public:
    GraphCounter() { cuda::launch_observer = this; }
    ~GraphCounter() { cuda::launch_observer = nullptr; }
    GraphCounter(const GraphCounter&) = delete;
    GraphCounter& operator=(const GraphCounter&) = delete;

    void before(const cuda::Launch& launch) override { count += launch.kind == cuda::LaunchKind::graph ? 1 : 0; }
    void after(const cuda::Launch&) noexcept override {}

    std::size_t count = 0;
};

/// A backend on the GPU, without what Reconstructor puts in front of it: the frames are valid.
class GpuBackend {
public:
    explicit GpuBackend(const Settings& settings)
        : backend_(cuda::make_reconstruction(settings, BackendOptions{}, std::make_shared<MemoryAccount>(),
                                             std::make_shared<MemoryAccount>())) {}

    /// expected: the CPU's mesh of the frame, whose lattice this one gets, since no backend finds it.
    const Mesh& reconstruct(const ParticleFrame& frame, const Mesh& expected) {
        mesh_.cell_size = expected.cell_size;
        mesh_.offset_bits = expected.offset_bits;
        Statistics statistics;
        backend_->reconstruct(frame, mesh_, statistics).finish();
        return mesh_;
    }

private:
    std::unique_ptr<BackendReconstruction> backend_;
    Mesh mesh_;
};

struct Scene {
    std::vector<float> positions;
    Mesh expected;

    ParticleFrame frame() const {
        ParticleFrame frame;
        frame.positions = positions;
        return frame;
    }
};

class Comparison {
public:
    Comparison(const SameOptions& options) : options_(options), table_(options.out, "same"), budget_(options.budget) {}

    void run() {
        for (const std::size_t particles : options_.particles)
            for (const std::string& water : options_.waters)
                for (const std::string& mode : options_.modes)
                    for (const std::string& field : options_.fields)
                        for (const double cell_size : options_.cell_sizes) {
                            Settings settings;
                            settings.particle_radius = static_cast<double>(particle_radius);
                            settings.cell_size = cell_size;
                            settings.mode = by_name<Mode>(mode, "mode");
                            settings.field = by_name<Field>(field, "field");
                            if (settings.field == Field::smooth) settings.spray = Spray::points;
                            compare({particles, by_name<WaterKind>(water, "water"), settings});
                        }
        nlohmann::ordered_json summary;
        summary["seconds"] = budget_.elapsed();
        summary["different"] = different_;
        summary["left_out"] = left_out_;
        table_.finish(summary);
        std::cout << table_.rows().size() << " rows, " << different_ << " different or failed, " << left_out_
                  << " left out for the budget of " << options_.budget << " s\n";
        if (different_ != 0)
            throw std::runtime_error(std::to_string(different_) +
                                     " comparisons of CPU and GPU differ or have failed: see " + options_.out +
                                     "/same.csv");
    }

private:
    void compare(const Case& chosen) {
        // As long as the slowest so far, for its size; the first is always compared.
        if (seconds_per_size_ > 0.0 && !budget_.allows(seconds_per_size_ * chosen.size())) {
            ++left_out_;
            Row row = chosen.row("all");
            add_result(row, "left_out", 0.0, Mesh(), {});
            table_.add(row);
            return;
        }
        const double begin = budget_.elapsed();
        std::array<Scene, 2> scenes;
        try {
            Reconstructor cpu(chosen.settings, {.backend = Backend::cpu});
            scenes[0].positions = make_any_water(chosen.water, chosen.particles, particle_radius);
            // Other data of about the same size: the mirror image, off the lattice's planes.
            scenes[1].positions = scenes[0].positions;
            for (std::size_t i = 0; i < scenes[1].positions.size(); i += 3)
                scenes[1].positions[i] = 0.4F * particle_radius - scenes[1].positions[i];
            for (Scene& scene : scenes) cpu.reconstruct(scene.frame(), scene.expected);
            run_in_turn(chosen, scenes);
            if (options_.threads > 1 && chosen.particles <= most_particles_in_threads) run_in_threads(chosen, scenes);
        } catch (const std::exception& error) {
            fail(chosen, "all", error.what());
        }
        seconds_per_size_ = std::max(seconds_per_size_, (budget_.elapsed() - begin) / chosen.size());
    }

    void run_in_turn(const Case& chosen, const std::array<Scene, 2>& scenes) {
        GpuBackend gpu(chosen.settings);
        // The first frame finds its room, the second settles there and is captured from the third on.
        const unsigned frames = 3 + options_.replays;
        for (unsigned i = 0; i < frames; ++i) {
            const Scene& scene = scenes[i % 2];
            const double begin = budget_.elapsed();
            const GraphCounter graphs;
            const Mesh& mesh = gpu.reconstruct(scene.frame(), scene.expected);
            const double seconds = budget_.elapsed() - begin;
            add_row(chosen, "frame " + std::to_string(i + 1) + (graphs.count != 0 ? " (graph)" : ""), seconds,
                    scene.expected, find_difference(scene.expected, mesh));
        }
    }

    /// All threads begin together, each with a backend of its own: their frames take turns, and what comes down does
    /// not.
    void run_in_threads(const Case& chosen, const std::array<Scene, 2>& scenes) {
        struct Result {
            MeshDifference difference;
            std::exception_ptr error;
        };
        constexpr unsigned frames = 3;
        std::vector<Result> results(options_.threads);
        const double begin = budget_.elapsed();
        {
            std::vector<std::jthread> threads;
            for (unsigned t = 0; t < options_.threads; ++t)
                threads.emplace_back([&, t] {
                    try {
                        GpuBackend gpu(chosen.settings);
                        for (unsigned i = 0; i < frames && !results[t].difference.any(); ++i) {
                            const Scene& scene = scenes[(i + t) % 2];
                            results[t].difference =
                                find_difference(scene.expected, gpu.reconstruct(scene.frame(), scene.expected));
                        }
                    } catch (...) {
                        results[t].error = std::current_exception();
                    }
                });
        }
        const double seconds = budget_.elapsed() - begin;
        for (unsigned t = 0; t < options_.threads; ++t) {
            const std::string run = "thread " + std::to_string(t + 1) + " of " + std::to_string(options_.threads);
            if (results[t].error) {
                try {
                    std::rethrow_exception(results[t].error);
                } catch (const std::exception& error) {
                    fail(chosen, run, error.what());
                }
                continue;
            }
            add_row(chosen, run, seconds, scenes[0].expected, results[t].difference);
        }
    }

    void add_row(const Case& chosen, const std::string& run, double seconds, const Mesh& expected,
                 const MeshDifference& difference) {
        Row row = chosen.row(run);
        if (difference.any()) ++different_;
        add_result(row, difference.any() ? "different" : "same", seconds, expected, difference);
        table_.add(row);
    }
    void fail(const Case& chosen, const std::string& run, std::string why) {
        ++different_;
        std::replace(why.begin(), why.end(), ',', ';');
        Row row = chosen.row(run);
        add_result(row, "failed", 0.0, Mesh(), {0, why});
        table_.add(row);
    }
    static void add_result(Row& row, const char* result, double seconds, const Mesh& expected,
                           const MeshDifference& difference) {
        row["result"] = result;
        row["seconds"] = seconds;
        row["vertices"] = expected.vertices.size();
        row["triangles"] = expected.triangles.size();
        row["bricks"] = expected.bricks.size();
        row["spray"] = expected.spray.size();
        row["different"] = difference.count;
        row["first_difference"] = difference.first;
    }

    const SameOptions& options_;
    GrowingTable table_;
    TimeBudget budget_;
    double seconds_per_size_ = 0.0;  ///< time over size() of the slowest case so far
    std::size_t different_ = 0;
    std::size_t left_out_ = 0;
};

}  // namespace

void add_same(CLI::App& app) {
    auto options = std::make_shared<SameOptions>();
    CLI::App& command = *app.add_subcommand(
        "same", "The GPU's meshes against the CPU's, to the byte; exit code 1 where they differ, 77 without a GPU");
    command.add_option("--particles", options->particles, "Numbers of particles, in basins of 16000, or fewer")
        ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 32U))
        ->delimiter(',')
        ->capture_default_str();
    command.add_option("--cell-sizes", options->cell_sizes, "In radii")
        ->check(CLI::PositiveNumber)
        ->delimiter(',')
        ->capture_default_str();
    command.add_option("--fields", options->fields, listed(names<Field>))->delimiter(',')->capture_default_str();
    command.add_option("--modes", options->modes, listed(names<Mode>))->delimiter(',')->capture_default_str();
    command.add_option("--waters", options->waters, listed(names<WaterKind>))->delimiter(',')->capture_default_str();
    command.add_option("--replays", options->replays, "Frames of each case that are replayed as graphs")
        ->check(CLI::Range(0U, 100'000U))
        ->capture_default_str();
    command
        .add_option("--threads", options->threads,
                    "Threads with a reconstruction each, all at once, up to a million particles; 1: none")
        ->check(CLI::Range(1U, 64U))
        ->capture_default_str();
    command.add_option("--budget", options->budget, "Seconds; cases that do not fit are left out; 0: no limit")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    command.add_option("--out", options->out, "Folder for same.csv and same.json")->capture_default_str();
    command.callback([options] {
        require_gpu();
        Comparison(*options).run();
    });
}

}  // namespace meniscus::benchmarks
