// Buffers for frames on their way out, used again once nobody refers to them.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "meniscus/memory.hpp"

namespace meniscus::client {

using Bytes = Array<std::byte>;

/// Thread-safe: gRPC lets go of a buffer in a thread of its own.
class BytePool : public std::enable_shared_from_this<BytePool> {
public:
    /// Takes memory of this size, whose content is undefined.
    std::shared_ptr<Bytes> take(std::size_t size) {
        std::unique_ptr<Bytes> bytes;
        {
            const std::lock_guard lock(mutex_);
            if (!free_.empty()) {
                bytes = std::move(free_.back());
                free_.pop_back();
            }
        }
        if (!bytes) bytes = std::make_unique<Bytes>();
        if (bytes->capacity() < size) *bytes = Bytes();
        bytes->resize(size);
        return {bytes.release(), [pool = weak_from_this()](Bytes* used) {
                    std::unique_ptr<Bytes> owned(used);
                    if (const auto alive = pool.lock()) alive->give(std::move(owned));
                }};
    }

private:
    static constexpr std::size_t kept = 3;  ///< one is filled while one is sent and one is on its way to be answered

    void give(std::unique_ptr<Bytes> bytes) {
        const std::lock_guard lock(mutex_);
        if (free_.size() < kept) free_.push_back(std::move(bytes));
    }

    std::mutex mutex_;
    std::vector<std::unique_ptr<Bytes>> free_;
};

}  // namespace meniscus::client
