// meniscus-bench kernels: where the time of a warm frame goes on the GPU, launch by launch, and as one graph.
#include <cuda_profiler_api.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/cuda/device.hpp"
#include "engine/cuda/launch.hpp"
#include "gpu/gpu.hpp"
#include "gpu/kernel_names.hpp"
#include "gpu/kernels_options.hpp"
#include "gpu/launch_times.hpp"
#include "report.hpp"
#include "warm_runs.hpp"

namespace meniscus::benchmarks {
namespace {

/// Each launch's seconds, one for every repeat.
struct TimedLaunch {
    cuda::Launch launch;
    std::vector<double> seconds;
};

/// Adds a kernel's grid, registers and shared memory.
void add_resources(Row& row, const cuda::Launch& launch) {
    if (launch.kind != cuda::LaunchKind::kernel) {
        row["blocks"] = nullptr;
        row["threads"] = nullptr;
        row["cooperative"] = nullptr;
        row["registers"] = nullptr;
        row["shared_bytes"] = nullptr;
        return;
    }
    cudaFuncAttributes attributes{};
    cuda::check(cudaFuncGetAttributes(&attributes, launch.kernel), "cudaFuncGetAttributes");
    row["blocks"] = launch.blocks;
    row["threads"] = cuda::block_threads;
    row["cooperative"] = launch.is_cooperative;
    row["registers"] = attributes.numRegs;
    row["shared_bytes"] = attributes.sharedSizeBytes;
}

std::string name_of(const cuda::Launch& launch) {
    if (launch.kind == cuda::LaunchKind::kernel) return kernel_name(launch.kernel);
    return std::string(launch.kind == cuda::LaunchKind::sort ? "CUB sort of " : "CUB sum of ") +
           std::to_string(launch.elements) + " x " + std::to_string(launch.element_bytes) + " bytes";
}

void add_times(Row& row, const std::vector<double>& seconds) {
    row["median_us"] = 1e6 * median(seconds);
    row["min_us"] = 1e6 * *std::min_element(seconds.begin(), seconds.end());
}

void add_total(GrowingTable& table, const std::string& name, double median_us, double min_us) {
    Row row = table.rows().at(0);
    for (auto& value : row) value = nullptr;
    row["kernel"] = name;
    row["median_us"] = median_us;
    row["min_us"] = min_us;
    table.add(row);
}

/// Launch by launch, in one stream: nothing overlaps, and an event lies between any two. A profiler that waits for the
/// application begins here: before a frame is warm, most of its launches find too little room and do nothing.
std::vector<TimedLaunch> time_launches(WarmFrame& frame, unsigned repeats, std::vector<double>& whole) {
    LaunchTimes times(LaunchTimes::What::kernels_and_calls);
    std::vector<TimedLaunch> launches;
    for (unsigned i = 0; i < repeats; ++i) {
        times.clear();
        cudaProfilerStart();
        frame.reconstruct();
        cudaProfilerStop();
        if (i == 0)
            for (std::size_t l = 0; l < times.count(); ++l) launches.push_back({times.launch(l), {}});
        if (times.count() != launches.size())
            throw std::runtime_error("a frame has launched " + std::to_string(times.count()) +
                                     " kernels and calls, the first one " + std::to_string(launches.size()));
        for (std::size_t l = 0; l < launches.size(); ++l) launches[l].seconds.push_back(times.seconds(l));
        whole.push_back(times.seconds());
    }
    return launches;
}

std::vector<double> time_graph(WarmFrame& frame, unsigned repeats) {
    LaunchTimes times(LaunchTimes::What::graphs);
    std::vector<double> seconds;
    for (unsigned i = 0; i < repeats; ++i) {
        times.clear();
        frame.reconstruct();
        if (times.count() != 1) throw std::runtime_error("a warm frame was not replayed as a graph");
        seconds.push_back(times.seconds());
    }
    return seconds;
}

void run_kernels(const KernelsOptions& options) {
    // Graphs first, since the environment chooses for the whole process.
    std::vector<double> graph;
    {
        WarmFrame frame(options, options.particles);
        frame.warm_up();
        graph = time_graph(frame, options.repeats);
    }
    setenv("MENISCUS_NO_GRAPH", "1", 1);
    WarmFrame frame(options, options.particles);
    frame.warm_up();
    std::vector<double> whole;
    const std::vector<TimedLaunch> launches = time_launches(frame, options.repeats, whole);

    GrowingTable table(options.out, "kernels");
    double sum = 0.0;
    double least = 0.0;
    for (std::size_t i = 0; i < launches.size(); ++i) {
        Row row;
        row["order"] = i + 1;
        row["kernel"] = name_of(launches[i].launch);
        add_resources(row, launches[i].launch);
        add_times(row, launches[i].seconds);
        sum += row["median_us"].get<double>();
        least += row["min_us"].get<double>();
        table.add(row);
    }
    const double graph_us = 1e6 * median(graph);
    const double graph_least = 1e6 * *std::min_element(graph.begin(), graph.end());
    add_total(table, "launches", sum, least);
    add_total(table, "frame", 1e6 * median(whole), 1e6 * *std::min_element(whole.begin(), whole.end()));
    add_total(table, "graph", graph_us, graph_least);
    add_total(table, "gaps", graph_us - sum, graph_least - least);
    nlohmann::ordered_json summary;
    summary["device"] = cuda::device_name(0);
    summary["particles"] = frame.particles();
    summary["water"] = options.water;
    summary["field"] = options.field;
    summary["mode"] = options.mode;
    summary["cell_size"] = options.cell_size;
    summary["repeats"] = options.repeats;
    table.finish(summary);
}

}  // namespace

void add_kernels(CLI::App& app, void (*run_model)(const KernelsOptions&)) {
    static void (*model)(const KernelsOptions&) = nullptr;
    model = run_model;
    add_kernels_command(app, [](const KernelsOptions& options) {
        if (options.is_model) return model(options);
        require_gpu();
        run_kernels(options);
    });
}

}  // namespace meniscus::benchmarks
