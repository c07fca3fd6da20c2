// The threads of the device in software.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include "cuda_runtime.h"

namespace emulated_device {

Index thread_index, block_index, block_size, grid_size;
std::function<void()> on_clock;

namespace {

[[noreturn]] void fail(const char* reason) {
    std::fprintf(stderr, "emulated device: %s (block %u, thread %u)\n", reason, block_index.x, thread_index.x);
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

/// What the lanes of a warp have given, for two waits in turn: nobody gets to the second next before all have read.
struct Warp {
    unsigned arrived = 0;
    unsigned passed = 0;
    int place = 0;
    std::uint64_t given[2][lanes] = {};
};

struct Fiber {
    std::unique_ptr<std::byte[]> stack = std::make_unique<std::byte[]>(stack_bytes);
    void* at = nullptr;
    bool done = false;
    const unsigned* waits_for = nullptr;  ///< to become another value than `seen`
    unsigned seen = 0;
};

struct Block {
    std::vector<Fiber> fibers;
    std::vector<Warp> warps;
    unsigned arrived = 0;
    unsigned passed = 0;
    unsigned finished = 0;
};

Block block;
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
    ++block.finished;
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

void run_block(unsigned threads) {
    static std::mt19937 random(1);
    if (block.fibers.size() < threads) block.fibers.resize(threads);
    block.warps.assign(threads / lanes, {});
    block.arrived = block.passed = block.finished = 0;
    for (unsigned i = 0; i < threads; ++i) prepare(block.fibers[i]);
    while (block.finished < threads) {
        bool progress = false;
        const unsigned first = static_cast<unsigned>(random());
        for (unsigned i = 0; i < threads; ++i) {
            const unsigned thread = (i + first) % threads;
            Fiber& fiber = block.fibers[thread];
            if (fiber.done || (fiber.waits_for != nullptr && *fiber.waits_for == fiber.seen)) continue;
            progress = true;
            thread_index.x = thread;
            running = &fiber;
            fiber.waits_for = nullptr;
            switch_stack(&scheduler, fiber.at);
        }
        if (!progress) fail("threads wait for some that do not come");
    }
}

}  // namespace

const std::uint64_t* exchange(std::uint64_t value, int place) {
    Warp& warp = block.warps[thread_index.x / lanes];
    const unsigned generation = warp.passed;
    if (warp.arrived != 0 && warp.place != place) fail("lanes of a warp wait at different places");
    warp.place = place;
    warp.given[generation % 2][thread_index.x % lanes] = value;
    if (++warp.arrived == lanes) {
        warp.arrived = 0;
        ++warp.passed;
    } else {
        wait_until_changed(warp.passed, generation);
    }
    return warp.given[generation % 2];
}

void wait_for_warp(int place) {
    exchange(0, place);
}

void wait_for_block() {
    const unsigned generation = block.passed;
    if (++block.arrived == block_size.x) {
        block.arrived = 0;
        ++block.passed;
    } else {
        wait_until_changed(block.passed, generation);
    }
}

void wait_for_grid() {
    if (grid_size.x != 1) fail("a kernel that waits for its grid was not launched as a cooperative one");
    wait_for_block();
}

void run_kernel(unsigned blocks, unsigned threads, const std::function<void()>& kernel) {
    kernel_body = &kernel;
    grid_size.x = blocks;
    block_size.x = threads;
    for (block_index.x = 0; block_index.x < blocks; ++block_index.x) run_block(threads);
}

}  // namespace emulated_device
