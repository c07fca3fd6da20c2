// The bytes of all sessions' frames that are on their way to be reconstructed.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>

namespace meniscus::server {

/// Thread-safe.
class BytesInFlight {
public:
    /// limit: bytes, 0 for none.
    explicit BytesInFlight(std::size_t limit = 0) : limit_(limit) {}

    /// Returns false, and adds nothing, if there would be more than the limit.
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

/// The part of one frame in them, until it is released.
class ShareInFlight {
public:
    explicit ShareInFlight(std::shared_ptr<BytesInFlight> all) : all_(std::move(all)) {}
    ~ShareInFlight() { release(); }
    ShareInFlight(ShareInFlight&& other) noexcept : all_(other.all_), bytes_(std::exchange(other.bytes_, 0)) {}
    ShareInFlight(const ShareInFlight&) = delete;
    ShareInFlight& operator=(const ShareInFlight&) = delete;
    ShareInFlight& operator=(ShareInFlight&&) = delete;

    /// Replaces what it had. Returns false, and has nothing, if that is too much.
    bool take(std::size_t bytes) noexcept {
        release();
        if (!all_->add(bytes)) return false;
        bytes_ = bytes;
        return true;
    }
    void release() noexcept { all_->remove(std::exchange(bytes_, 0)); }
    const BytesInFlight& all() const noexcept { return *all_; }

private:
    const std::shared_ptr<BytesInFlight> all_;
    std::size_t bytes_ = 0;
};

}  // namespace meniscus::server
