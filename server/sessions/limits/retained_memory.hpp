// A part of the memory of all sessions, held without an array of its own account.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "meniscus/memory.hpp"

namespace meniscus::server {

/// Given back when it is destroyed. One thread at a time.
class RetainedMemory {
public:
    /// memory: may be none, which counts nothing.
    explicit RetainedMemory(std::shared_ptr<SharedMemory> memory = nullptr) : memory_(std::move(memory)) {}
    ~RetainedMemory() { drop(); }
    RetainedMemory(const RetainedMemory&) = delete;
    RetainedMemory& operator=(const RetainedMemory&) = delete;
    /// The other one holds nothing afterwards.
    RetainedMemory(RetainedMemory&& other) noexcept : RetainedMemory(other.memory_) {
        bytes_ = std::exchange(other.bytes_, 0);
    }
    RetainedMemory& operator=(RetainedMemory&& other) noexcept {
        drop();
        memory_ = other.memory_;
        bytes_ = std::exchange(other.bytes_, 0);
        return *this;
    }

    /// Returns whether there was room.
    bool hold(std::size_t bytes) noexcept {
        drop();
        if (memory_ == nullptr) return true;
        if (memory_->try_charge(bytes) != 0) return false;
        bytes_ = bytes;
        return true;
    }
    void drop() noexcept {
        if (memory_ != nullptr) memory_->release(std::exchange(bytes_, 0));
    }

private:
    std::shared_ptr<SharedMemory> memory_;
    std::size_t bytes_ = 0;
};

}  // namespace meniscus::server
