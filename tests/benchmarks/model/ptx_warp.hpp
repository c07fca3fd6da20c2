// The warps of a launch: 32 lanes in lockstep, their block and their grid.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/gpu_caches.hpp"
#include "model/gpu_constants.hpp"
#include "model/ptx_grid.hpp"
#include "model/ptx_module.hpp"

namespace meniscus::benchmarks {

constexpr unsigned warp_lanes = 32;

/// The state that the warps of a launch share.
struct PtxGrid {
    const PtxLaunch& launch;
    void* const* parameters;
    const GpuConstants& gpu;
    LaunchCounts counts;
    Footprint footprint;
    std::uint32_t workspace[2] = {0, 0};  ///< memory of grid barriers: the second word is their counter
    double first_cache_latency, second_cache_latency, shared_latency, atomic_latency;

    PtxGrid(const PtxLaunch& l, void* const* p, const GpuConstants& g)
        : launch(l),
          parameters(p),
          gpu(g),
          first_cache_latency(g["first_cache_latency"]),
          second_cache_latency(g["second_cache_latency"]),
          shared_latency(g["shared_latency"]),
          atomic_latency(g["atomic_latency"]) {}
};

/// A block's shared memory, first cache and barrier.
class PtxBlock {
public:
    PtxBlock(const PtxProgram& program, const PtxGrid& grid)
        : shared(program.kernel().shared_bytes + 16),
          cache(static_cast<std::uint64_t>(grid.gpu["first_cache_bytes"]) /
                std::max(1U, grid.launch.blocks_of_processor)) {
        std::fill(shared.begin(), shared.end(), std::byte{0xA5});
    }
    std::vector<std::byte> shared;
    FirstCache cache;
    unsigned index = 0;
    unsigned at_barrier = 0;  ///< warps that wait there
    unsigned running = 0;     ///< warps that have not ended
    double barrier_clock = 0.0;
};

/// 32 lanes with their registers. Lanes at one instruction are a group; the lowest group runs first.
class PtxWarp {
public:
    enum class State : std::uint8_t { runs, waits_for_block, ended };

    PtxWarp(PtxProgram& program, PtxGrid& grid) : program_(program), grid_(grid) {
        slots_.resize(static_cast<std::size_t>(program.kernel().slots));
        ready_.resize(slots_.size());
    }
    void begin(PtxBlock& block, unsigned warp);
    /// Until it ends, waits for its block, or has asked for a word that others may change.
    void run();
    State state = State::ended;
    PtxBlock* block = nullptr;
    double clock = 0.0;
    /// In use, summed over all instructions of all blocks.
    std::uint64_t lanes_in_use() const { return lanes_; }

private:
    struct Group {
        std::int32_t at;
        std::uint32_t mask;
        bool waits;  ///< whether it waits for other lanes, to act together
    };

    PtxLanes& slot(std::int32_t i) { return slots_[static_cast<std::size_t>(i)]; }
    std::uint64_t* values(std::int32_t i) { return slot(i).of; }
    void park(std::int32_t at, std::uint32_t mask, bool waits);
    /// Goes on with the lowest group that does not wait; false without any.
    bool take_next();
    /// Lanes that are parked at the current instruction go on with the others.
    void join_here();
    /// Whether all lanes of the mask are here; parks this group otherwise.
    bool all_here(std::uint32_t wanted);
    void account(const PtxInstruction& i, const InstructionCost& cost, std::uint32_t mask, double latency);
    std::byte* address(const PtxInstruction& i, unsigned lane);
    double access(const PtxInstruction& i, std::uint32_t mask);
    double load(const PtxInstruction& i, std::uint32_t mask);
    double store(const PtxInstruction& i, std::uint32_t mask);
    double change(const PtxInstruction& i, std::uint32_t mask);
    void shuffle(const PtxInstruction& i, std::uint32_t mask);

    PtxProgram& program_;
    PtxGrid& grid_;
    std::vector<PtxLanes> slots_;
    std::vector<double> ready_;  ///< cycle at which each slot's value can be used
    std::vector<Group> parked_;
    std::int32_t at_ = 0;
    std::uint32_t mask_ = 0;

    std::uint64_t lanes_ = 0;
};

}  // namespace meniscus::benchmarks
