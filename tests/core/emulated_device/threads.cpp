// The threads of the device in software.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "cuda_runtime.h"

namespace emulated_device {

Index thread_index, block_index, block_size, grid_size;
std::function<void()> on_clock;

namespace {

[[noreturn]] void fail(const std::string& reason) {
    std::fprintf(stderr, "emulated device: %s (block %u, thread %u)\n", reason.c_str(), block_index.x, thread_index.x);
    std::abort();
}

/// Saves the registers that a function call keeps and goes on with another stack.
__attribute__((naked)) void switch_stack(void** /*save*/, void* /*to*/) {
    __asm__(
        "pushq %rbp\n pushq %rbx\n pushq %r12\n pushq %r13\n pushq %r14\n pushq %r15\n"
        "movq %rsp, (%rdi)\n movq %rsi, %rsp\n"
        "popq %r15\n popq %r14\n popq %r13\n popq %r12\n popq %rbx\n popq %rbp\n ret\n");
}

constexpr unsigned lanes = 32;
constexpr std::size_t stack_bytes = std::size_t{128} << 10;

/// Where threads wait together.
struct Waiting {
    Meeting meeting{};
    Place place;
    unsigned mask = 0;

    bool operator==(const Waiting& other) const {
        return meeting == other.meeting && mask == other.mask && place.line() == other.place.line() &&
               place.column() == other.place.column();
    }
    std::string text() const {
        static constexpr const char* names[] = {"__syncwarp",      "__ballot_sync", "__shfl_sync", "__shfl_up_sync",
                                                "__shfl_xor_sync", "__syncthreads", "grid sync"};
        char mask_text[32];
        std::snprintf(mask_text, sizeof(mask_text), " by mask %08X", mask);
        return std::string(names[static_cast<std::size_t>(meeting)]) + " in line " + std::to_string(place.line()) +
               mask_text;
    }
};

inline void require_same(const Waiting& first, const Waiting& own) {
    if (!(first == own)) [[unlikely]]
        fail("threads meet at different places: " + first.text() + ", and " + own.text());
}

/// What the lanes of a warp have given, for two waits in turn: nobody gets to the second next before all have read.
struct Warp {
    unsigned arrived = 0;  ///< a bit for every lane
    unsigned passed = 0;
    Waiting waiting;
    std::uint64_t given[2][lanes] = {};
};

struct Fiber {
    std::unique_ptr<std::byte[]> stack = std::make_unique<std::byte[]>(stack_bytes);
    void* at = nullptr;
    bool done = false;
    const unsigned* waits_for = nullptr;  ///< to become another value than `seen`
    unsigned seen = 0;
};

/// All threads of a block, or of a grid.
struct Barrier {
    unsigned arrived = 0;
    unsigned passed = 0;
    Waiting waiting;
};

/// A variable in shared memory, with a guard behind it.
struct SharedVariable {
    static constexpr std::size_t guard_bytes = 64;
    static constexpr std::byte guard{0xDD};
    static constexpr std::byte rubbish{0xA5};

    unsigned line;
    std::size_t bytes;
    std::unique_ptr<std::byte[]> room;
    std::byte* memory;

    SharedVariable(unsigned of_line, std::size_t size, std::size_t alignment)
        : line(of_line), bytes(size), room(std::make_unique<std::byte[]>(size + alignment + guard_bytes)) {
        void* begin = room.get();
        std::size_t space = size + alignment;
        memory = static_cast<std::byte*>(std::align(alignment, size, begin, space));
        std::fill_n(memory, size, rubbish);
        std::fill_n(memory + size, guard_bytes, guard);
    }
    bool is_whole() const {
        return std::all_of(memory + bytes, memory + bytes + guard_bytes, [](std::byte b) { return b == guard; });
    }
};

struct Block {
    unsigned index = 0;
    std::vector<Fiber> fibers;
    std::vector<Warp> warps;
    std::vector<SharedVariable> shared;
    Barrier barrier;
    unsigned finished = 0;
};

constexpr unsigned blocks_at_once = 2;  ///< of a grid that is not cooperative

std::mt19937 order(1);
std::vector<std::unique_ptr<Block>> live;
Barrier grid_barrier;
bool grid_is_cooperative = false;
Block* block = nullptr;
Fiber* running = nullptr;
void* scheduler = nullptr;
const std::function<void()>* kernel_body = nullptr;

void yield() {
    switch_stack(&running->at, scheduler);
}

void wait_until_changed(const unsigned& counter, unsigned seen) {
    running->waits_for = &counter;
    running->seen = seen;
    yield();
}

void run_thread() {
    (*kernel_body)();
    running->done = true;
    ++block->finished;
    yield();
}

void prepare(Fiber& fiber) {
    fiber.done = false;
    fiber.waits_for = nullptr;
    // Six registers and the address to return to; the stack is aligned as after a call.
    auto* end = fiber.stack.get() + stack_bytes;
    end -= reinterpret_cast<std::uintptr_t>(end) % 16;
    auto** top = reinterpret_cast<void**>(end) - 8;
    std::fill(top, top + 6, nullptr);
    top[6] = reinterpret_cast<void*>(&run_thread);
    top[7] = nullptr;
    fiber.at = top;
}

void begin(Block& new_block, unsigned index) {
    new_block.index = index;
    if (new_block.fibers.size() < block_size.x) new_block.fibers.resize(block_size.x);
    new_block.warps.assign(block_size.x / lanes, {});
    new_block.shared.clear();
    new_block.barrier = {};
    new_block.finished = 0;
    for (unsigned i = 0; i < block_size.x; ++i) prepare(new_block.fibers[i]);
}

void end(const Block& old_block) {
    for (const SharedVariable& variable : old_block.shared)
        if (!variable.is_whole())
            fail("shared memory was overrun: the variable of " + std::to_string(variable.bytes) +
                 " bytes declared in line " + std::to_string(variable.line));
}

/// Lets the lanes of a warp go on that wait for nothing; returns whether there were any.
bool run_warp(Block& of, unsigned warp) {
    bool progress = false;
    const unsigned first = static_cast<unsigned>(order());
    for (unsigned i = 0; i < lanes; ++i) {
        const unsigned thread = lanes * warp + (i + first) % lanes;
        Fiber& fiber = of.fibers[thread];
        if (fiber.done || (fiber.waits_for != nullptr && *fiber.waits_for == fiber.seen)) continue;
        progress = true;
        thread_index.x = thread;
        block_index.x = of.index;
        block = &of;
        running = &fiber;
        fiber.waits_for = nullptr;
        switch_stack(&scheduler, fiber.at);
    }
    return progress;
}

/// Runs the first `count` live blocks, in an order of chance from warp to warp, until one of them has ended; returns
/// which.
unsigned run_until_one_ends(unsigned count) {
    const unsigned warps = block_size.x / lanes;
    std::vector<unsigned> turns(count * warps);
    std::iota(turns.begin(), turns.end(), 0U);
    for (;;) {
        bool progress = false;
        std::shuffle(turns.begin(), turns.end(), order);
        for (const unsigned turn : turns) progress |= run_warp(*live[turn / warps], turn % warps);
        for (unsigned i = 0; i < count; ++i)
            if (live[i]->finished == block_size.x) return i;
        if (!progress) fail("threads wait for some that do not come");
    }
}

void wait_at(Barrier& barrier, unsigned threads, const Waiting& waiting) {
    if (barrier.arrived == 0) barrier.waiting = waiting;
    require_same(barrier.waiting, waiting);
    const unsigned generation = barrier.passed;
    if (++barrier.arrived == threads) {
        barrier.arrived = 0;
        ++barrier.passed;
    } else {
        wait_until_changed(barrier.passed, generation);
    }
}

}  // namespace

void seed_order(unsigned seed) {
    order.seed(seed);
}

const std::uint64_t* exchange(std::uint64_t value, unsigned mask, Meeting meeting, const Place& place) {
    Warp& warp = block->warps[thread_index.x / lanes];
    const unsigned lane = thread_index.x % lanes;
    const Waiting waiting{meeting, place, mask};
    if (warp.arrived == 0) warp.waiting = waiting;
    require_same(warp.waiting, waiting);
    if ((mask >> lane & 1) == 0) fail("a lane is not in its own mask: " + waiting.text());
    const unsigned generation = warp.passed;
    warp.given[generation % 2][lane] = value;
    warp.arrived |= 1U << lane;
    if (warp.arrived == mask) {
        warp.arrived = 0;
        ++warp.passed;
    } else {
        wait_until_changed(warp.passed, generation);
    }
    return warp.given[generation % 2];
}

void wait_for_block(const Place& place) {
    wait_at(block->barrier, block_size.x, {Meeting::sync_block, place, ~0U});
}

void wait_for_grid(const Place& place) {
    if (!grid_is_cooperative) fail("a kernel that waits for its grid was not launched as a cooperative one");
    wait_at(grid_barrier, grid_size.x * block_size.x, {Meeting::sync_grid, place, ~0U});
}

void* shared_memory(std::size_t bytes, std::size_t alignment, unsigned line) {
    for (const SharedVariable& variable : block->shared)
        if (variable.line == line) return variable.memory;
    return block->shared.emplace_back(line, bytes, alignment).memory;
}

void run_kernel(unsigned blocks, unsigned threads, bool cooperative, const std::function<void()>& kernel) {
    kernel_body = &kernel;
    grid_size.x = blocks;
    block_size.x = threads;
    grid_is_cooperative = cooperative;
    grid_barrier = {};
    std::vector<unsigned> waiting(blocks);
    std::iota(waiting.begin(), waiting.end(), 0U);
    std::shuffle(waiting.begin(), waiting.end(), order);
    unsigned count = std::min(blocks, cooperative ? blocks : blocks_at_once);
    while (live.size() < count) live.push_back(std::make_unique<Block>());
    const auto begin_next = [&](unsigned place) {
        begin(*live[place], waiting.back());
        waiting.pop_back();
    };
    for (unsigned i = 0; i < count; ++i) begin_next(i);
    while (count != 0) {
        const unsigned ended = run_until_one_ends(count);
        end(*live[ended]);
        if (!waiting.empty())
            begin_next(ended);
        else
            std::swap(live[ended], live[--count]);
    }
}

}  // namespace emulated_device
