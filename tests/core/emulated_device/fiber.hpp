// Threads of control with stacks of their own, between which a thread of the host changes; on x86-64.
#pragma once

#include <cstddef>

namespace emulated_device {

/// Stacks side by side, for the fibers of one block.
class Stacks {
public:
    explicit Stacks(std::size_t count);
    ~Stacks();
    Stacks(const Stacks&) = delete;
    Stacks& operator=(const Stacks&) = delete;

    std::byte* operator[](std::size_t i) const { return begin_ + i * stack_bytes; }

    /// Odd in lines of the cache: else the ends of all stacks, which are what is in use, would compete for few of them.
    static constexpr std::size_t stack_bytes = (std::size_t{256} << 10) + 9 * 64;

private:
    std::byte* begin_;
    std::size_t bytes_;
};

/// One that is not prepared stands for the host's thread.
class Fiber {
public:
    /// Makes it begin with entry() when it is changed to, on a stack of Stacks::stack_bytes. entry() must not return.
    void prepare(std::byte* stack, void (*entry)());

    /// Leaves `from`, the running fiber, for `to`; comes back when something changes to `from`.
    static void change(Fiber& from, Fiber& to) { change(from, to, false); }
    /// The same for a fiber that has come to its end.
    [[noreturn]] static void leave(Fiber& from, Fiber& to);
    /// Called first by entry().
    static void arrive();

private:
    static void change(Fiber& from, Fiber& to, bool for_good);

    void* at_ = nullptr;  ///< the stack's pointer, while it does not run
    // For the address sanitizer.
    const void* stack_ = nullptr;
    std::size_t stack_bytes_ = 0;
    void* fake_stack_ = nullptr;
};

}  // namespace emulated_device
