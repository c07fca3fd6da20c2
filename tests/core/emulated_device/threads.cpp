// The threads of the device in software: blocks of warps of lanes, each lane a fiber.
//
// Lanes of a warp take turns: each goes on until it waits for others. A warp goes on for a number of turns that chance
// chooses, then another one does: some warps get far ahead of others, as on a GPU, so that a barrier that is missing
// shows.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "cuda_runtime.h"
#include "fiber.hpp"
#include "meeting.hpp"
#include "shared_variable.hpp"

namespace emulated_device {

Index thread_index, block_index, block_size, grid_size;
std::function<void()> on_clock;
std::function<void(bool)> on_kernel;
std::function<void(const void*)> on_addition;

namespace {

constexpr unsigned lanes = 32;
constexpr unsigned all_lanes = ~0U;
constexpr unsigned most_turns = 16;     ///< turns of a warp, one after the other
constexpr unsigned blocks_at_once = 2;  ///< running blocks of a grid that is not cooperative

struct Block;

/// Meetings of some lanes of a warp, always the same ones.
struct Meetings {
    unsigned mask = 0;  ///< set of these lanes; 0: there was no meeting
    unsigned arrived = 0;
    unsigned number = 0;  ///< number of the next meeting
    Waiting waiting;
};

/// Values that lanes have given, for two meetings in turn: no lane gets to the second next before all have read.
using Given = std::array<std::array<std::uint64_t, lanes>, 2>;

/// Lanes are bits of its sets.
struct Warp {
    Block* block = nullptr;
    unsigned first_thread = 0;
    std::array<Fiber, lanes> fibers;
    unsigned ready = 0;  ///< lanes that wait for nothing
    unsigned turn = 0;   ///< ready lanes that are still to go on in this turn
    unsigned turns = 0;  ///< turns to come before another warp goes on
    bool is_listed = false;

    Meetings whole;
    Given given_to_whole{};
    Meetings parts[lanes];  ///< meetings of parts, by their lowest lane
    Given given_to_parts{};
    unsigned in_parts = 0;  ///< number of lanes that wait for others of their part
};

struct Block {
    unsigned index = 0;
    std::unique_ptr<Stacks> stacks;
    std::vector<Warp> warps;
    std::vector<SharedVariable> shared;
    Barrier barrier;
    std::vector<Block*> alone{this};
    unsigned finished = 0;  ///< number of threads that have ended
};

std::mt19937 order(1);
std::vector<Block*> live;  ///< blocks whose threads run
std::vector<Warp*> ready_warps;
Barrier grid_barrier;
bool grid_is_cooperative = false;
Warp* warp = nullptr;  ///< the running one
Fiber host;
const std::function<void()>* kernel_body = nullptr;

[[noreturn]] void fail(const std::string& reason) {
    std::fprintf(stderr, "emulated device: %s (block %u, thread %u)\n", reason.c_str(), block_index.x, thread_index.x);
    std::abort();
}

void require_same(const Waiting& first, const Waiting& own) {
    if (!(first == own)) [[unlikely]]
        fail("threads meet at different places: " + first.text() + ", and " + own.text());
}

unsigned running_lane() {
    return thread_index.x % lanes;
}

/// The fiber that goes on when the running one cannot.
Fiber& next_fiber() {
    if (warp->turn == 0) {
        if (warp->turns == 0 || warp->ready == 0) return host;
        --warp->turns;
        warp->turn = warp->ready;
    }
    // Lanes go on in order from the running one; which of them is the first in a turn varies thereby.
    const unsigned behind = running_lane() + 1;
    const unsigned lane =
        (behind + static_cast<unsigned>(std::countr_zero(std::rotr(warp->turn, static_cast<int>(behind))))) % lanes;
    warp->turn &= ~(1U << lane);
    thread_index.x = warp->first_thread + lane;
    return warp->fibers[lane];
}

void wait() {
    Fiber& own = warp->fibers[running_lane()];
    warp->ready &= ~(1U << running_lane());
    Fiber::change(own, next_fiber());
}

void let_go_on(Warp& of, unsigned mask) {
    of.ready |= mask;
    if (!std::exchange(of.is_listed, true)) ready_warps.push_back(&of);
}

void run_thread() {
    Fiber::arrive();
    (*kernel_body)();
    Fiber& own = warp->fibers[running_lane()];
    warp->ready &= ~(1U << running_lane());
    ++warp->block->finished;
    Fiber::leave(own, next_fiber());
}

void begin(Block& block, unsigned index) {
    const unsigned warps = block_size.x / lanes;
    if (block.warps.size() != warps) {
        block.stacks = std::make_unique<Stacks>(block_size.x);
        block.warps = std::vector<Warp>(warps);
    }
    block.index = index;
    block.shared.clear();
    block.barrier = {};
    block.finished = 0;
    for (unsigned w = 0; w < warps; ++w) {
        Warp& own = block.warps[w];
        own.block = &block;
        own.first_thread = w * lanes;
        own.whole.arrived = own.in_parts = 0;
        for (Meetings& part : own.parts) part.arrived = part.mask = 0;
        for (unsigned lane = 0; lane < lanes; ++lane)
            own.fibers[lane].prepare((*block.stacks)[w * lanes + lane], &run_thread);
        let_go_on(own, all_lanes);
    }
}

void end(const Block& block) {
    for (const SharedVariable& variable : block.shared)
        if (!variable.is_whole())
            fail("shared memory was overrun: the variable of " + std::to_string(variable.bytes) +
                 " bytes declared in line " + std::to_string(variable.line));
}

/// Runs warps in an order of chance until a block has ended; returns it.
Block& run_until_one_ends() {
    for (;;) {
        if (ready_warps.empty()) fail("threads wait for some that do not come");
        const std::size_t chosen = order() % ready_warps.size();
        warp = ready_warps[chosen];
        warp->turns = 1 + order() % most_turns;
        block_index.x = warp->block->index;
        thread_index.x = warp->first_thread + order() % lanes;
        Fiber::change(host, next_fiber());
        if (warp->ready == 0) {
            warp->is_listed = false;
            ready_warps[chosen] = ready_warps.back();
            ready_warps.pop_back();
        }
        if (warp->block->finished == block_size.x) return *warp->block;
    }
}

/// The meetings that a lane comes to: of all lanes, or of a part of a warp that is the same for as long as a block
/// runs. Lanes of one part may wait for all others while those of another still meet, but not at the same place.
Meetings& meetings_of(Warp& own, const Waiting& waiting) {
    const auto require_other_place = [&](const Meetings& of_others) {
        if (of_others.arrived != 0 && of_others.waiting.is_at_place_of(waiting)) [[unlikely]]
            require_same(of_others.waiting, waiting);
    };
    if (waiting.mask == all_lanes) {
        if (own.in_parts != 0) [[unlikely]]
            for (const Meetings& part : own.parts) require_other_place(part);
        return own.whole;
    }
    require_other_place(own.whole);
    Meetings& part = own.parts[std::countr_zero(waiting.mask)];
    if (part.mask != waiting.mask) {
        for (const Meetings& other : own.parts)
            if ((other.mask & waiting.mask) != 0) require_same(other.waiting, waiting);
        part.mask = waiting.mask;
    }
    return part;
}

/// Meetings for the number of threads of these blocks.
void wait_at(Barrier& barrier, unsigned threads, const std::vector<Block*>& blocks, const Waiting& waiting) {
    if (barrier.arrived == 0) barrier.waiting = waiting;
    require_same(barrier.waiting, waiting);
    if (++barrier.arrived < threads) {
        wait();
    } else {
        barrier.arrived = 0;
        for (Block* const block : blocks)
            for (Warp& own : block->warps) let_go_on(own, all_lanes);
    }
}

}  // namespace

void seed_order(unsigned seed) {
    order.seed(seed);
}

const std::uint64_t* exchange(std::uint64_t value, unsigned mask, Meeting meeting, Place place) {
    Warp& own = *warp;
    const unsigned lane = running_lane();
    const Waiting waiting{meeting, place, mask};
    if ((mask >> lane & 1) == 0) fail("a lane is not in its own mask: " + waiting.text());
    Meetings& meetings = meetings_of(own, waiting);
    if (meetings.arrived == 0) meetings.waiting = waiting;
    require_same(meetings.waiting, waiting);
    Given& given_to = mask == all_lanes ? own.given_to_whole : own.given_to_parts;
    std::uint64_t* const given = given_to[meetings.number % 2].data();
    given[lane] = value;
    meetings.arrived |= 1U << lane;
    if (meetings.arrived != mask) {
        if (mask != all_lanes) own.in_parts |= 1U << lane;
        wait();
    } else {
        meetings.arrived = 0;
        own.in_parts &= ~mask;
        ++meetings.number;
        own.ready |= mask;
    }
    return given;
}

void wait_for_block(Place place) {
    Block& block = *warp->block;
    wait_at(block.barrier, block_size.x, block.alone, {Meeting::sync_block, place, all_lanes});
}

void wait_for_grid(Place place) {
    if (!grid_is_cooperative) fail("a kernel that waits for its grid was not launched as a cooperative one");
    wait_at(grid_barrier, grid_size.x * block_size.x, live, {Meeting::sync_grid, place, all_lanes});
}

void* shared_memory(std::size_t bytes, std::size_t alignment, unsigned line) {
    std::vector<SharedVariable>& shared = warp->block->shared;
    for (const SharedVariable& variable : shared)
        if (variable.line == line) return variable.memory;
    return shared.emplace_back(line, bytes, alignment).memory;
}

void run_kernel(unsigned blocks, unsigned threads, bool cooperative, const std::function<void()>& kernel) {
    static std::vector<std::unique_ptr<Block>> pool;
    if (on_kernel) on_kernel(cooperative);
    kernel_body = &kernel;
    grid_size.x = blocks;
    block_size.x = threads;
    grid_is_cooperative = cooperative;
    grid_barrier = {};
    std::vector<unsigned> waiting(blocks);
    std::iota(waiting.begin(), waiting.end(), 0U);
    std::shuffle(waiting.begin(), waiting.end(), order);
    const auto begin_next = [&](Block& block) {
        begin(block, waiting.back());
        waiting.pop_back();
    };
    const std::size_t at_once = std::min(blocks, cooperative ? blocks : blocks_at_once);
    while (pool.size() < at_once) pool.push_back(std::make_unique<Block>());
    for (std::size_t i = 0; i < at_once; ++i) {
        live.push_back(pool[i].get());
        begin_next(*pool[i]);
    }
    while (!live.empty()) {
        Block& ended = run_until_one_ends();
        end(ended);
        if (waiting.empty())
            std::erase(live, &ended);
        else
            begin_next(ended);
    }
}

}  // namespace emulated_device
