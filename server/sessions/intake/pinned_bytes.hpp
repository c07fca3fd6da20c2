// The memory of a frame, pinned while it stays where it is.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include "meniscus/memory.hpp"

namespace meniscus::server {

/// Pins once the bytes have arrived: an announcement alone takes no memory of the machine. One thread at a time.
class PinnedBytes {
public:
    /// pinning: may be none, which pins nothing.
    explicit PinnedBytes(std::shared_ptr<PagePinning> pinning = nullptr) : pinning_(std::move(pinning)) {}
    ~PinnedBytes() { drop(); }
    /// The other one holds nothing afterwards.
    PinnedBytes(PinnedBytes&& other) noexcept
        : pinning_(other.pinning_), begin_(std::exchange(other.begin_, nullptr)) {}
    PinnedBytes(const PinnedBytes&) = delete;
    PinnedBytes& operator=(const PinnedBytes&) = delete;
    PinnedBytes& operator=(PinnedBytes&&) = delete;

    /// Nothing is done where this memory is pinned already.
    void hold(std::span<std::byte> memory) noexcept {
        if (pinning_ == nullptr || begin_ == memory.data() || memory.size() < PagePinning::least_bytes) return;
        drop();
        begin_ = memory.data();
        pinning_->pin(begin_, memory.size());
    }
    /// Unpins the memory, before it is freed or goes elsewhere.
    void drop() noexcept {
        if (void* const begin = std::exchange(begin_, nullptr)) pinning_->unpin(begin);
    }

private:
    const std::shared_ptr<PagePinning> pinning_;
    void* begin_ = nullptr;
};

}  // namespace meniscus::server
