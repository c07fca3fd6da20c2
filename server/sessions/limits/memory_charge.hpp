// Memory that is no array of ours, counted in an account.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "meniscus/memory.hpp"

namespace meniscus::server {

/// Charges bytes until its end. Throws LimitExceeded as MemoryAccount::charge() does.
class MemoryCharge {
public:
    /// account: none: uncounted.
    MemoryCharge(std::shared_ptr<MemoryAccount> account, std::size_t bytes)
        : account_(std::move(account)), bytes_(bytes) {
        if (account_) account_->charge(bytes_);
    }
    ~MemoryCharge() {
        if (account_) account_->release(bytes_);
    }
    MemoryCharge(const MemoryCharge&) = delete;
    MemoryCharge& operator=(const MemoryCharge&) = delete;

private:
    const std::shared_ptr<MemoryAccount> account_;
    const std::size_t bytes_;
};

}  // namespace meniscus::server
