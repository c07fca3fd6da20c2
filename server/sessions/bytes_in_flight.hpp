// The bytes of all sessions' frames that are on their way to be reconstructed.
#pragma once

#include <atomic>
#include <cstddef>

namespace meniscus::server {

/// Thread-safe.
class BytesInFlight {
public:
    /// limit: bytes, 0 for none.
    explicit BytesInFlight(std::size_t limit = 0) : limit_(limit) {}

    /// False, without adding them, if there would be more than the limit.
    bool add(std::size_t bytes) noexcept {
        std::size_t before = bytes_.load(std::memory_order_relaxed);
        do {
            if (limit_ != 0 && (before > limit_ || bytes > limit_ - before)) return false;
        } while (!bytes_.compare_exchange_weak(before, before + bytes, std::memory_order_relaxed));
        return true;
    }
    void remove(std::size_t bytes) noexcept { bytes_.fetch_sub(bytes, std::memory_order_relaxed); }

    std::size_t bytes() const noexcept { return bytes_.load(std::memory_order_relaxed); }
    std::size_t limit() const noexcept { return limit_; }

private:
    const std::size_t limit_;
    std::atomic<std::size_t> bytes_{0};
};

}  // namespace meniscus::server
