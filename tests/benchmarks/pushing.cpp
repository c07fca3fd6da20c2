// meniscus-bench pushing: processor time of a push on a simulation's own thread, against one copy of its particles.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "benchmarks.hpp"
#include "meniscus/live_parts.hpp"
#include "moving_frames.hpp"
#include "processor_time.hpp"
#include "report.hpp"
#include "support/thread_exchange.hpp"
#include "warm_runs.hpp"
#include "water.hpp"

namespace meniscus::benchmarks {
namespace {

struct PushingOptions {
    std::size_t particles = 100'000;
    std::size_t ranks = 4;
    unsigned frames = 20;
    std::string out = "tests/benchmarks/results";
};

constexpr float radius_of_pushed = 0.025F;

/// How the simulation holds its particles.
enum class Deal { slabs, random };
constexpr std::array<std::pair<Deal, const char*>, 2> deals{{{Deal::slabs, "slabs"}, {Deal::random, "at random"}}};

/// The particles of each rank, x y z.
Frames dealt(const std::vector<float>& water, std::size_t ranks, Deal deal) {
    std::vector<std::uint32_t> order(water.size() / 3);
    std::iota(order.begin(), order.end(), 0U);
    if (deal == Deal::random)
        std::shuffle(order.begin(), order.end(), std::mt19937(1));  // NOLINT(cert-msc51-cpp): the same in each run
    else
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return water[3 * a] < water[3 * b]; });
    Frames all(ranks);
    for (std::size_t i = 0; i < order.size(); ++i) {
        const auto p = water.begin() + std::ptrdiff_t{3} * order[i];
        std::vector<float>& its = all[i * ranks / order.size()];
        its.insert(its.end(), p, p + 3);
    }
    return all;
}

/// Takes parts, and keeps none of them.
class NoPublisher final : public LivePublisher {
public:
    void publish(const LivePart& /*part*/) override {}
    void abandon() noexcept override {}
};

/// Counts what a rank sends to others: particles, and what parts tell those that touch them.
class CountingExchange final : public PartExchange {
public:
    explicit CountingExchange(PartExchange& exchange) : exchange_(exchange) {}
    std::size_t rank() const override { return exchange_.rank(); }
    std::size_t ranks() const override { return exchange_.ranks(); }
    std::vector<Bytes> gather(Bytes mine) override { return exchange_.gather(std::move(mine)); }
    void all_to_all(std::vector<Bytes>& to, std::vector<Bytes>& from) override {
        for (std::size_t rank = 0; rank < to.size(); ++rank)
            if (rank != exchange_.rank()) bytes_ += to[rank].size();
        exchange_.all_to_all(to, from);
    }
    std::uint64_t bytes() const { return bytes_; }

private:
    PartExchange& exchange_;
    std::uint64_t bytes_ = 0;
};

struct Measured {
    std::vector<double> push_seconds, copy_seconds;
    double sent = 0.0;  ///< bytes to other ranks, over those of its particles
};

/// A rank's life. Processor time of this thread alone: the exchange sleeps where another rank is waited for, and what
/// the thread of the parts takes is not the simulation's.
Measured push_frames(PartExchange& ranks, const std::vector<float>& positions, std::vector<std::size_t> makers,
                     unsigned count) {
    Settings settings;
    settings.particle_radius = radius_of_pushed;
    NoPublisher publisher;
    CountingExchange exchange(ranks);
    const std::size_t parts = makers.size();
    LiveParts live(settings, {.backend = Backend::cpu, .threads = 1}, {.parts = parts, .makers = std::move(makers)},
                   LivePolicy::latest, exchange, publisher);
    const Frames frames = moving(positions, settings, count);
    std::vector<float> moved(positions.size()), copy(positions.size());
    Measured measured;
    for (std::uint64_t step = 0; measured.push_seconds.size() < count; ++step) {
        // As a simulation that has just moved them.
        const std::vector<float>& now = frames[measured.push_seconds.size()];
        std::copy(now.begin(), now.end(), moved.begin());
        double before = thread_seconds();
        std::copy(moved.begin(), moved.end(), copy.begin());
        const double copy_seconds = thread_seconds() - before;
        before = thread_seconds();
        const bool is_taken = live.push(frame_of(moved), step, 0.0);
        const double push_seconds = thread_seconds() - before;
        if (is_taken) {
            measured.copy_seconds.push_back(copy_seconds);
            measured.push_seconds.push_back(push_seconds);
        } else {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));  // a step of the simulation
        }
    }
    live.finish();
    measured.sent = static_cast<double>(exchange.bytes()) /
                    static_cast<double>(std::size_t{count} * positions.size() * sizeof(float));
    return measured;
}

Row measure(const Frames& of_ranks, std::size_t makers, unsigned frames) {
    std::vector<std::size_t> those(makers);
    for (std::size_t i = 0; i < makers; ++i) those[i] = i * of_ranks.size() / makers;
    std::vector<double> ratios(of_ranks.size()), pushes(of_ranks.size()), sent(of_ranks.size());
    test::on_ranks(of_ranks.size(), [&](PartExchange& exchange) {
        const std::size_t rank = exchange.rank();
        Measured measured = push_frames(exchange, of_ranks[rank], those, frames);
        pushes[rank] = median(std::move(measured.push_seconds));
        ratios[rank] = pushes[rank] / median(std::move(measured.copy_seconds));
        sent[rank] = measured.sent;
    });
    Row row;
    row["least_over_a_copy"] = *std::min_element(ratios.begin(), ratios.end());
    row["greatest_over_a_copy"] = *std::max_element(ratios.begin(), ratios.end());
    row["greatest_push_processor_seconds"] = *std::max_element(pushes.begin(), pushes.end());
    row["bytes_between_ranks_over_particles"] =
        std::accumulate(sent.begin(), sent.end(), 0.0) / static_cast<double>(sent.size());
    return row;
}

void run_pushing(const PushingOptions& options) {
    std::cout << "particles of   makers   over a copy: least   greatest rank   ms of the greatest   sent\n"
              << std::fixed;
    const std::vector<float> water =
        make_water(WaterKind::splashing, options.ranks * options.particles, radius_of_pushed);
    Rows rows = Rows::array();
    for (const auto& [deal, name] : deals) {
        const Frames of_ranks = dealt(water, options.ranks, deal);
        for (const std::size_t makers : {std::size_t{1}, options.ranks}) {
            Row row;
            row["deal"] = name;
            row["makers"] = makers;
            row["particles_of_a_rank"] = of_ranks[0].size() / 3;
            row.update(measure(of_ranks, makers, options.frames));
            std::cout << std::setw(12) << name << std::setw(9) << makers << std::setprecision(2) << std::setw(21)
                      << row["least_over_a_copy"].get<double>() << std::setw(16)
                      << row["greatest_over_a_copy"].get<double>() << std::setw(21)
                      << 1e3 * row["greatest_push_processor_seconds"].get<double>() << std::setw(7)
                      << row["bytes_between_ranks_over_particles"].get<double>() << std::endl;
            rows.push_back(row);
        }
    }
    nlohmann::ordered_json summary;
    summary["runs"] =
        "processor time of a rank's own thread in push(), over that of a copy of its particles, medians; frames: " +
        std::to_string(options.frames);
    summary["input"] = "splashing water that moves, float32 positions alone";
    summary["ranks"] = std::to_string(options.ranks) + " threads, whose exchange sleeps while it waits";
    write_report(options.out, "pushing", summary, rows);
}

}  // namespace

void add_pushing(CLI::App& app) {
    auto options = std::make_shared<PushingOptions>();
    CLI::App& command = *app.add_subcommand(
        "pushing",
        "Processor time that a push of ranks takes on a simulation's thread, against a copy of its particles");
    command.add_option("--particles", options->particles, "Of a rank, about")->capture_default_str();
    command.add_option("--ranks", options->ranks, "Processes, as threads of this one")
        ->check(CLI::Range(1U, 1000U))
        ->capture_default_str();
    command.add_option("--frames", options->frames, "Of which the median counts")
        ->check(CLI::Range(1U, 100'000U))
        ->capture_default_str();
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    command.callback([options] { run_pushing(*options); });
}

}  // namespace meniscus::benchmarks
