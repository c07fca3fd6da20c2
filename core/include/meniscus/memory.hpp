// Memory that is counted and limited: every array of a reconstruction is charged to one account.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace meniscus {

/// The memory that several accounts have together. Thread-safe.
class SharedMemory {
public:
    /// Frees memory of these accounts, if it can, given the number of missing bytes. Called by the thread that asks for
    /// them.
    using MakeRoom = std::function<void(std::size_t missing)>;

    /// limit: bytes, 0 for none. make_room: called before a charge is refused; may be empty.
    explicit SharedMemory(std::size_t limit = 0, MakeRoom make_room = nullptr)
        : limit_(limit), make_room_(std::move(make_room)) {}

    /// Returns false, without charging, if there would be more than the limit.
    bool charge(std::size_t bytes);
    /// Makes no room. Returns how many bytes are missing; if none is, they are charged.
    std::size_t try_charge(std::size_t bytes) noexcept;
    void release(std::size_t bytes) noexcept { bytes_.fetch_sub(bytes, std::memory_order_relaxed); }

    std::size_t bytes() const noexcept { return bytes_.load(std::memory_order_relaxed); }
    std::size_t limit() const noexcept { return limit_; }

private:
    const std::size_t limit_;
    const MakeRoom make_room_;
    std::atomic<std::size_t> bytes_{0};
};

/// Keeps arrays where they are in the host's memory, so that a GPU copies from and to them by itself. Thread-safe.
class PagePinning {
public:
    /// Arrays of fewer bytes are not worth it, and may share their pages with others; see allocate_aligned().
    static constexpr std::size_t least_bytes = std::size_t{64} << 10;

    virtual ~PagePinning() = default;
    /// Memory that cannot be pinned stays as it is: it is only copied more slowly.
    virtual void pin(void* begin, std::size_t bytes) noexcept = 0;
    /// Before memory that was passed to pin() is freed, once nothing is copied from or to it.
    virtual void unpin(void* begin) noexcept = 0;
};

/// Counts the bytes and the allocations of the arrays charged to it, and refuses an array that would pass its limit.
/// Thread-safe.
class MemoryAccount {
public:
    /// limit: bytes, 0 for none. place: where the memory is, in words, for the message of a refusal. shared: charged,
    /// too; may be none. pinning: of large arrays; none: they are not pinned.
    explicit MemoryAccount(std::size_t limit = 0, const char* place = "in memory",
                           std::shared_ptr<SharedMemory> shared = nullptr,
                           std::shared_ptr<PagePinning> pinning = nullptr)
        : limit_(limit), place_(place), shared_(std::move(shared)), pinning_(std::move(pinning)) {}

    /// Throws MemoryLimitExceeded, without charging, if the account would pass its limit, or the shared memory its own.
    void charge(std::size_t bytes);
    void release(std::size_t bytes) noexcept;
    /// For charges from now on. limit: as the constructor's; what is held may be more.
    void set_limit(std::size_t limit) noexcept { limit_.store(limit, std::memory_order_relaxed); }
    /// Pins and unpins an array that is charged: after its allocation, and before it is freed.
    void pin(void* array, std::size_t bytes) noexcept {
        if (pinning_ && bytes >= PagePinning::least_bytes) pinning_->pin(array, bytes);
    }
    void unpin(void* array, std::size_t bytes) noexcept {
        if (pinning_ && bytes >= PagePinning::least_bytes) pinning_->unpin(array);
    }

    /// Whether large arrays are pinned.
    bool pins() const noexcept { return pinning_ != nullptr; }

    std::size_t bytes() const noexcept { return bytes_.load(std::memory_order_relaxed); }
    std::size_t peak_bytes() const noexcept { return peak_.load(std::memory_order_relaxed); }
    std::uint64_t allocations() const noexcept { return allocations_.load(std::memory_order_relaxed); }
    std::size_t limit() const noexcept { return limit_.load(std::memory_order_relaxed); }

private:
    std::atomic<std::size_t> limit_;
    const char* place_;
    std::shared_ptr<SharedMemory> shared_;
    std::shared_ptr<PagePinning> pinning_;
    std::atomic<std::size_t> bytes_{0};
    std::atomic<std::size_t> peak_{0};
    std::atomic<std::uint64_t> allocations_{0};
};

/// Memory aligned to a cache line, from PagePinning::least_bytes on in pages of its own; null if no memory is left.
void* allocate_aligned(std::size_t bytes) noexcept;
void free_aligned(void* memory) noexcept;

/// Allocator that charges an account and leaves trivial elements uninitialized on resize. Without an account, memory is
/// not counted.
template <class T>
class AccountAllocator {
public:
    using value_type = T;
    using propagate_on_container_move_assignment = std::true_type;
    using propagate_on_container_swap = std::true_type;

    AccountAllocator() noexcept = default;
    explicit AccountAllocator(std::shared_ptr<MemoryAccount> account) noexcept : account_(std::move(account)) {}
    template <class U>
    AccountAllocator(const AccountAllocator<U>& other) noexcept : account_(other.account()) {}

    T* allocate(std::size_t n) {
        const std::size_t bytes = n * sizeof(T);
        if (account_) account_->charge(bytes);
        void* memory = allocate_aligned(bytes);
        if (memory == nullptr) {
            if (account_) account_->release(bytes);
            throw std::bad_alloc();
        }
        if (account_) account_->pin(memory, bytes);
        return static_cast<T*>(memory);
    }
    void deallocate(T* p, std::size_t n) noexcept {
        if (account_) account_->unpin(p, n * sizeof(T));
        free_aligned(p);
        if (account_) account_->release(n * sizeof(T));
    }
    template <class U, class... Args>
    void construct(U* p, Args&&... args) {
        if constexpr (sizeof...(Args) == 0 && std::is_trivially_destructible_v<U>)
            ::new (static_cast<void*>(p)) U;  // default-initialized: no pass over memory that is about to be written
        else
            ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
    }
    const std::shared_ptr<MemoryAccount>& account() const noexcept { return account_; }
    template <class U>
    bool operator==(const AccountAllocator<U>& other) const noexcept {
        return account_ == other.account();
    }

private:
    std::shared_ptr<MemoryAccount> account_;
};

/// The library's array: a std::vector whose memory is counted, and whose new elements are not set on resize.
template <class T>
using Array = std::vector<T, AccountAllocator<T>>;

}  // namespace meniscus
