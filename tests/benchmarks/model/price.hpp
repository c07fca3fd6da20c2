// The time that a launch's counts ask for on a GPU: the slowest of what it needs.
#pragma once

#include <string>

#include "model/gpu_constants.hpp"
#include "model/ptx_grid.hpp"

namespace meniscus::benchmarks {

/// Of a kernel as compiled.
struct KernelResources {
    unsigned registers = 0;     ///< a thread
    unsigned shared_bytes = 0;  ///< a block
    double instructions = 0.0;  ///< of its machine code
};

/// Microseconds, each as if nothing else took time.
struct Price {
    double issue = 0.0;  ///< to issue all instructions
    double pipe = 0.0;   ///< in the busiest pipe
    std::string pipe_name;
    double memory = 0.0;  ///< passes through the first cache and shared memory
    double second_cache = 0.0;
    double device_memory = 0.0;
    double latency = 0.0;  ///< warps that wait, as many at once as fit
    double longest_warp = 0.0;
    double barriers = 0.0;  ///< of the whole grid

    /// The greatest, and the barriers.
    double total() const;
    /// What the greatest is.
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
