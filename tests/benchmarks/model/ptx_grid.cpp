#include "model/ptx_grid.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

#include "model/ptx_warp.hpp"

namespace meniscus::benchmarks {
namespace {

/// In which threads only ask for a word that others may change.
constexpr unsigned most_idle_rounds = 100'000;

}  // namespace

LaunchCounts& LaunchCounts::operator+=(const LaunchCounts& other) {
    issued += other.issued;
    for (std::size_t p = 0; p < pipe_count; ++p) pipe[p] += other.pipe[p];
    ptx += other.ptx;
    lanes += other.lanes;
    memory_passes += other.memory_passes;
    sectors += other.sectors;
    missed_sectors += other.missed_sectors;
    own_sectors += other.own_sectors;
    warp_cycles += other.warp_cycles;
    longest_warp = std::max(longest_warp, other.longest_warp);
    grid_barriers += other.grid_barriers;
    warps += other.warps;
    blocks += other.blocks;
    return *this;
}

PtxProgram::PtxProgram(PtxKernel kernel, const InstructionCosts& costs) : kernel_(std::move(kernel)) {
    for (const PtxInstruction& i : kernel_.instructions) cost_.push_back(costs.of(i.opcode));
    executed_.resize(kernel_.instructions.size());
}

double PtxProgram::static_issued() const {
    double sum = 0.0;
    for (const InstructionCost& cost : cost_) sum += cost.issued;
    return sum;
}

LaunchCounts PtxProgram::run(const PtxLaunch& launch, void* const* parameters, const GpuConstants& gpu) {
    PtxGrid grid(launch, parameters, gpu);
    const std::vector<std::uint64_t> executed_before = executed_;
    const unsigned warps_of_block = launch.threads / warp_lanes;
    const unsigned at_once = launch.is_cooperative ? launch.blocks : 1;
    std::vector<std::unique_ptr<PtxWarp>> warps;
    for (unsigned w = 0; w < at_once * warps_of_block; ++w) warps.push_back(std::make_unique<PtxWarp>(*this, grid));
    for (unsigned first = 0; first < launch.blocks; first += at_once) {
        std::vector<std::unique_ptr<PtxBlock>> blocks;
        for (unsigned b = 0; b < at_once; ++b) {
            blocks.push_back(std::make_unique<PtxBlock>(*this, grid));
            blocks.back()->index = first + b;
            blocks.back()->running = warps_of_block;
            for (unsigned w = 0; w < warps_of_block; ++w) warps[b * warps_of_block + w]->begin(*blocks.back(), w);
        }
        unsigned running = at_once * warps_of_block;
        unsigned idle_rounds = 0;
        while (running != 0) {
            if (++idle_rounds > most_idle_rounds)
                throw std::runtime_error("threads wait for a word that nobody changes: " + kernel_.name);
            bool progress = false;
            for (const auto& warp : warps) {
                if (warp->state != PtxWarp::State::runs) continue;
                progress = true;
                warp->run();
                if (warp->state != PtxWarp::State::runs) idle_rounds = 0;
                if (warp->state == PtxWarp::State::ended) {
                    --running;
                    --warp->block->running;
                    grid.counts.warp_cycles += warp->clock;
                    grid.counts.longest_warp = std::max(grid.counts.longest_warp, warp->clock);
                } else if (warp->state == PtxWarp::State::waits_for_block) {
                    ++warp->block->at_barrier;
                    warp->block->barrier_clock = std::max(warp->block->barrier_clock, warp->clock);
                }
            }
            for (const auto& warp : warps) {
                PtxBlock& block = *warp->block;
                if (block.at_barrier == 0 || block.at_barrier != block.running) continue;
                for (const auto& other : warps)
                    if (other->block == &block && other->state == PtxWarp::State::waits_for_block) {
                        other->state = PtxWarp::State::runs;
                        other->clock = block.barrier_clock;
                    }
                block.at_barrier = 0;
                block.barrier_clock = 0.0;
                progress = true;
            }
            if (!progress) throw std::runtime_error("warps wait for some that do not come: " + kernel_.name);
        }
    }
    for (const auto& warp : warps) grid.counts.lanes += static_cast<double>(warp->lanes_in_use());
    for (std::size_t i = 0; i < executed_.size(); ++i) {
        const auto times = static_cast<double>(executed_[i] - executed_before[i]);
        grid.counts.ptx += times;
        grid.counts.issued += times * cost_[i].issued;
        grid.counts.pipe[static_cast<std::size_t>(cost_[i].pipe)] += times * cost_[i].cycles_of_pipe;
    }
    grid.counts.warps = std::uint64_t{launch.blocks} * warps_of_block;
    grid.counts.blocks = launch.blocks;
    if (launch.is_cooperative) grid.counts.grid_barriers /= launch.blocks;
    return grid.counts;
}

}  // namespace meniscus::benchmarks
