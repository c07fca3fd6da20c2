#include "fiber.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <new>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/common_interface_defs.h>
#endif

// Saves the registers that a function call keeps, and goes on with another stack.
extern "C" void emulated_device_change_stack(void** save, void* to);
__asm__(
    ".text\n"
    ".type emulated_device_change_stack, @function\n"
    "emulated_device_change_stack:\n"
    "pushq %rbp\n pushq %rbx\n pushq %r12\n pushq %r13\n pushq %r14\n pushq %r15\n"
    "movq %rsp, (%rdi)\n movq %rsi, %rsp\n"
    "popq %r15\n popq %r14\n popq %r13\n popq %r12\n popq %rbx\n popq %rbp\n ret\n"
    ".size emulated_device_change_stack, . - emulated_device_change_stack\n");

namespace emulated_device {

namespace {
Fiber* left = nullptr;  ///< the fiber that was left last
}

Stacks::Stacks(std::size_t count) : bytes_(count * stack_bytes) {
    // Pages that no fiber touches take no memory.
    void* const begin =
        mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (begin == MAP_FAILED) throw std::bad_alloc();
    begin_ = static_cast<std::byte*>(begin);
}
Stacks::~Stacks() {
    munmap(begin_, bytes_);
}

void Fiber::prepare(std::byte* stack, void (*entry)()) {
    stack_ = stack;
    stack_bytes_ = Stacks::stack_bytes;
    fake_stack_ = nullptr;
    // Six registers and the address to return to; the stack is aligned as after a call.
    auto** const top = reinterpret_cast<void**>(stack + Stacks::stack_bytes) - 8;
    std::fill(top, top + 6, nullptr);
    top[6] = reinterpret_cast<void*>(entry);
    top[7] = nullptr;
    at_ = top;
}

void Fiber::leave(Fiber& from, Fiber& to) {
    change(from, to, true);
    std::abort();
}

void Fiber::change(Fiber& from, Fiber& to, [[maybe_unused]] bool for_good) {
    left = &from;
#ifdef __SANITIZE_ADDRESS__
    __sanitizer_start_switch_fiber(for_good ? nullptr : &from.fake_stack_, to.stack_, to.stack_bytes_);
#endif
    emulated_device_change_stack(&from.at_, to.at_);
#ifdef __SANITIZE_ADDRESS__
    __sanitizer_finish_switch_fiber(from.fake_stack_, &left->stack_, &left->stack_bytes_);
#endif
}

void Fiber::arrive() {
#ifdef __SANITIZE_ADDRESS__
    __sanitizer_finish_switch_fiber(nullptr, &left->stack_, &left->stack_bytes_);
#endif
}

}  // namespace emulated_device
