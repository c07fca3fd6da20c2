// meniscus-bench exact: what the backend takes for granted of a GPU: roots, quotients and fused sums that are rounded
// as the host's are, and CUB's sorts and sums.
#include <CLI/CLI.hpp>
#include <memory>
#include <stdexcept>
#include <string>

#include "engine/cuda/device.hpp"
#include "gpu/exact_checks.hpp"
#include "gpu/gpu.hpp"
#include "gpu/time_budget.hpp"
#include "report.hpp"

namespace meniscus::benchmarks {
namespace {

struct ExactOptions {
    std::uint64_t roots = std::uint64_t{1} << 32;
    std::uint64_t quotients = std::uint64_t{1} << 30;
    std::uint64_t elements = 10'000'000;
    std::string out = "exact-results";
};

void run_exact(const ExactOptions& options) {
    GrowingTable table(options.out, "exact");
    const TimeBudget clock(0.0);
    double begin = 0.0;
    std::size_t failed = 0;
    const OnChecked add = [&](const Checked& checked) {
        const double now = clock.elapsed();
        if (checked.different != 0) ++failed;
        table.add({{"check", checked.check},
                   {"n", checked.n},
                   {"run", checked.run},
                   {"result", checked.different == 0 ? "same" : "different"},
                   {"seconds", now - begin},
                   {"different", checked.different},
                   {"first_difference", checked.first_difference}});
        begin = now;
    };
    check_scans(options.elements, add);
    check_rounding(options.roots, options.quotients, add);
    nlohmann::ordered_json summary;
    summary["device"] = cuda::device_name(0);
    summary["different"] = failed;
    table.finish(summary);
    if (failed != 0)
        throw std::runtime_error(std::to_string(failed) + " checks differ between CPU and GPU: see " + options.out +
                                 "/exact.csv");
}

}  // namespace

void add_exact(CLI::App& app) {
    auto options = std::make_shared<ExactOptions>();
    CLI::App& command = *app.add_subcommand(
        "exact",
        "Roots, quotients and fused sums of the GPU against the CPU's, CUB's sorts and sums against the standard "
        "library's; exit code 1 where they differ, 77 without a GPU");
    command
        .add_option_function<std::uint64_t>(
            "--roots",
            [options](std::uint64_t n) {
                if ((n & (n - 1)) != 0) throw CLI::ValidationError("--roots", "must be a power of two");
                options->roots = n;
            },
            "Arguments of roots and reciprocals, evenly over all bit patterns: a power of two, 2^32 for all")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 32))
        ->default_str("4294967296");
    command.add_option("--quotients", options->quotients, "Quotients and fused sums, of bits at random")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40))
        ->capture_default_str();
    command.add_option("--elements", options->elements, "Of the largest array that is sorted or summed, at most")
        ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{10'000'000}))
        ->capture_default_str();
    command.add_option("--out", options->out, "Folder for exact.csv and exact.json")->capture_default_str();
    command.callback([options] {
        require_gpu();
        run_exact(*options);
    });
}

}  // namespace meniscus::benchmarks
