// Runs a kernel's PTX as a GPU would, warp by warp in lockstep, on the device in software's memory, and counts. Lanes
// that part meet again at the lowest instruction that they have not passed. What is counted is what the warps do; what
// is computed are the kernel's own bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "model/gpu_constants.hpp"
#include "model/ptx_module.hpp"

namespace meniscus::benchmarks {

/// Counts over all warps of a launch.
struct LaunchCounts {
    double issued = 0.0;           ///< machine instructions of warps, by the costs of PTX
    double pipe[pipe_count] = {};  ///< number of those that go to each pipe
    double ptx = 0.0;              ///< PTX instructions of warps
    double lanes = 0.0;            ///< lanes in use, summed over these
    double memory_passes = 0.0;    ///< 128-byte lines and shared memory's banks that are asked one after another
    double sectors = 0.0;          ///< sectors of 32 bytes that warps ask global memory for
    double missed_sectors = 0.0;   ///< those that are not in the first cache
    double own_sectors = 0.0;      ///< different ones
    double warp_cycles = 0.0;      ///< sum of the cycles that each would take alone on the GPU
    double longest_warp = 0.0;     ///< cycles
    double grid_barriers = 0.0;
    std::uint64_t warps = 0;
    std::uint64_t blocks = 0;

    LaunchCounts& operator+=(const LaunchCounts& other);
};

/// A launch's shape.
struct PtxLaunch {
    unsigned blocks = 1;
    unsigned threads = 256;
    bool is_cooperative = false;
    unsigned blocks_of_processor = 1;  ///< blocks that share a first cache
};

/// A kernel whose costs are known.
class PtxProgram {
public:
    PtxProgram(PtxKernel kernel, const InstructionCosts& costs);
    /// parameters: addresses of the arguments. Throws std::runtime_error where threads wait for some that do not come,
    /// or a kernel traps.
    LaunchCounts run(const PtxLaunch& launch, void* const* parameters, const GpuConstants& gpu);

    const PtxKernel& kernel() const { return kernel_; }
    const InstructionCost& cost(std::size_t instruction) const { return cost_[instruction]; }
    void add_execution(std::size_t instruction) { ++executed_[instruction]; }
    /// Machine instructions of the kernel's text by the costs of PTX: to be compared with the assembler's.
    double static_issued() const;
    /// How often warps have executed each instruction since the program began.
    const std::vector<std::uint64_t>& executed() const { return executed_; }

private:
    PtxKernel kernel_;
    std::vector<InstructionCost> cost_;  ///< cost of each instruction
    std::vector<std::uint64_t> executed_;
};

}  // namespace meniscus::benchmarks
