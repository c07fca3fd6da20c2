// The time that a launch's counts ask for on a GPU: the slowest of what it needs.
#pragma once

#include <string>

#include "model/gpu_constants.hpp"
#include "model/ptx_grid.hpp"

namespace meniscus::benchmarks {

/// The resources of a kernel as compiled.
struct KernelResources {
    unsigned registers = 0;     ///< a thread
    unsigned shared_bytes = 0;  ///< a block
    double instructions = 0.0;  ///< number of them in its machine code
};

/// Microseconds, each as if nothing else took time.
struct Price {
    double issue = 0.0;  ///< time to issue all instructions
    double pipe = 0.0;   ///< time in the busiest pipe
    std::string pipe_name;
    double memory = 0.0;  ///< passes through the first cache and shared memory
    double second_cache = 0.0;
    double device_memory = 0.0;
    double latency = 0.0;  ///< warps that wait, as many at once as fit
    double longest_warp = 0.0;
    double barriers = 0.0;  ///< time of the barriers of the whole grid

    /// The greatest, and the barriers.
    double total() const;
    /// The name of the greatest.
    std::string bound() const;
};

/// Blocks of a kernel that a multiprocessor holds.
unsigned blocks_of_processor(const KernelResources& kernel, unsigned threads, const GpuConstants& gpu);

/// times: the frame is as many times the counted one.
Price price_launch(const LaunchCounts& counts, double times, const KernelResources& kernel, double static_issued,
                   unsigned threads, const GpuConstants& gpu);

/// CUB's sorts and sums, by what they read and write: a sort's passes of eight bits of the keys, a sum in one pass;
/// microseconds. bytes: of a key with its value.
double price_sort(double elements, double bytes, unsigned key_bits, const GpuConstants& gpu);
double price_sum(double elements, double bytes, const GpuConstants& gpu);

}  // namespace meniscus::benchmarks
