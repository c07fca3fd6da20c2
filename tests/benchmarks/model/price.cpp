#include "model/price.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace meniscus::benchmarks {
namespace {

constexpr double lanes_of_warp = 32.0;
constexpr double bytes_of_sector = 32.0;
constexpr const char* pipe_names[pipe_count] = {"none", "fp32", "integer", "half", "fp64", "memory", "shuffle"};

/// Registers are given out to warps in steps.
constexpr unsigned register_step = 256;

auto parts(const Price& p) {
    return std::array<std::pair<double, const char*>, 7>{{{p.issue, "issue"},
                                                          {p.pipe, "pipe"},
                                                          {p.memory, "first cache"},
                                                          {p.second_cache, "second cache"},
                                                          {p.device_memory, "device memory"},
                                                          {p.latency, "latency"},
                                                          {p.longest_warp, "longest warp"}}};
}

}  // namespace

double Price::total() const {
    const auto all = parts(*this);
    return std::max_element(all.begin(), all.end())->first + barriers;
}

std::string Price::bound() const {
    const auto all = parts(*this);
    const std::string name = std::max_element(all.begin(), all.end())->second;
    return name == "pipe" ? "pipe " + pipe_name : name;
}

unsigned blocks_of_processor(const KernelResources& kernel, unsigned threads, const GpuConstants& gpu) {
    const unsigned warps = threads / static_cast<unsigned>(lanes_of_warp);
    unsigned blocks = std::min(gpu.count("blocks"), gpu.count("warps") / warps);
    if (kernel.registers != 0) {
        const unsigned of_warp = (kernel.registers * static_cast<unsigned>(lanes_of_warp) + register_step - 1) /
                                 register_step * register_step;
        blocks = std::min(blocks, gpu.count("registers") / of_warp / warps);
    }
    if (kernel.shared_bytes != 0) blocks = std::min(blocks, gpu.count("shared_bytes") / (kernel.shared_bytes + 1024));
    return std::max(1U, blocks);
}

Price price_launch(const LaunchCounts& counts, double times, const KernelResources& kernel, double static_issued,
                   unsigned threads, const GpuConstants& gpu) {
    const double processors = gpu["processors"];
    const double cycles_a_us = 1e3 * gpu["clock_ghz"];
    // Machine instructions of this kernel over those by the table of costs: the assembler folds and it adds.
    const double as_compiled = static_issued > 0.0 ? kernel.instructions / static_issued : 1.0;
    Price price;
    price.issue = times * counts.issued * as_compiled / (processors * gpu["issue"] * cycles_a_us);
    for (std::size_t p = 1; p < pipe_count; ++p) {
        if (static_cast<Pipe>(p) == Pipe::memory) continue;  // see below
        const double us = times * counts.pipe[p] * lanes_of_warp / (gpu[pipe_names[p]] * processors * cycles_a_us);
        if (us <= price.pipe) continue;
        price.pipe = us;
        price.pipe_name = pipe_names[p];
    }
    price.memory = times * std::max(counts.memory_passes, counts.pipe[static_cast<std::size_t>(Pipe::memory)]) /
                   (processors * cycles_a_us);
    price.second_cache = times * counts.missed_sectors * bytes_of_sector / (1e3 * gpu["second_cache_gbs"]);
    price.device_memory = times * counts.own_sectors * bytes_of_sector / (1e3 * gpu["memory_gbs"]);
    const double warps_of_block = threads / lanes_of_warp;
    const double fit = blocks_of_processor(kernel, threads, gpu) * warps_of_block;
    const double there = static_cast<double>(counts.warps) * times / processors;
    price.latency = times * counts.warp_cycles / (std::min(fit, std::max(1.0, there)) * processors * cycles_a_us);
    price.longest_warp = counts.longest_warp / cycles_a_us;
    price.barriers = counts.grid_barriers * gpu["grid_barrier_us"];
    return price;
}

double price_sort(double elements, double bytes, unsigned key_bits, const GpuConstants& gpu) {
    // A pass reads and writes all, after one that only reads.
    const unsigned passes = (key_bits + 7) / 8;
    const double pass_us = 2.0 * elements * bytes / (1e3 * gpu["memory_gbs"]);
    const double least_us =
        3.0 * gpu["launch_us"];  // a pass is a memset and a kernel whose blocks wait for those before
    return passes * std::max(pass_us, least_us) + pass_us / 2.0 + 2.0 * gpu["launch_us"];
}

double price_sum(double elements, double bytes, const GpuConstants& gpu) {
    return 2.0 * elements * bytes / (1e3 * gpu["memory_gbs"]) + 2.0 * gpu["launch_us"];
}

}  // namespace meniscus::benchmarks
