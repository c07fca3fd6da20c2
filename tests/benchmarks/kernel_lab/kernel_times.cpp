#include "kernel_times.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "gpu/kernel_names.hpp"
#include "gpu/launch_times.hpp"
#include "meniscus/reconstructor.hpp"
#include "warm_runs.hpp"

namespace meniscus::benchmarks {
namespace {

struct KernelTime {
    unsigned launches = 0;       ///< number of them in a frame
    std::vector<double> frames;  ///< milliseconds of all launches in each frame
};

std::string name_of(const cuda::Launch& launch) {
    if (launch.kind == cuda::LaunchKind::kernel) return kernel_name(launch.kernel);
    return launch.kind == cuda::LaunchKind::sort ? "sorts of CUB" : "sums of CUB";
}

}  // namespace

void print_kernel_times(const ParticleFrame& frame, const Settings& settings, unsigned runs) {
    setenv("MENISCUS_NO_GRAPH", "1", 1);
    Reconstructor reconstructor(settings, {Backend::cuda, 0, 0});
    Mesh mesh;
    for (int warm_up = 0; warm_up < 2; ++warm_up) reconstructor.reconstruct(frame, mesh);
    std::map<std::string, KernelTime> kernels;
    LaunchTimes times(LaunchTimes::What::kernels_and_calls);
    for (unsigned run = 0; run < runs; ++run) {
        times.clear();
        reconstructor.reconstruct(frame, mesh);
        for (std::size_t i = 0; i < times.count(); ++i) {
            KernelTime& kernel = kernels[name_of(times.launch(i))];
            if (run == 0) ++kernel.launches;
            kernel.frames.resize(run + 1);
            kernel.frames[run] += 1e3 * times.seconds(i);
        }
    }
    unsetenv("MENISCUS_NO_GRAPH");
    std::vector<std::pair<double, std::string>> sorted;
    double sum = 0.0;
    for (auto& [name, kernel] : kernels) {
        sorted.emplace_back(median(kernel.frames), name);
        sum += sorted.back().first;
    }
    std::sort(sorted.rbegin(), sorted.rend());
    for (const auto& [milliseconds, name] : sorted)
        std::printf("    %8.3f ms %3.0f %% %3u x %s\n", milliseconds, sum > 0.0 ? 100.0 * milliseconds / sum : 0.0,
                    kernels[name].launches, name.c_str());
    std::printf("    %8.3f ms in all kernels, one after the other\n", sum);
}

}  // namespace meniscus::benchmarks
