// The memory that a session's encoding works in.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "meniscus/brick_coding.hpp"

namespace meniscus::server {

/// Scratch memories, one for each thread that encodes bricks of a frame at the same time; charged to one account, and
/// freed with the pool. Thread-safe.
class ScratchPool {
public:
    /// One scratch memory, until it is destroyed.
    class Loan {
    public:
        explicit Loan(ScratchPool& pool) : pool_(pool), scratch_(pool.take()) {}
        ~Loan() { pool_.give(std::move(scratch_)); }
        Loan(const Loan&) = delete;
        Loan& operator=(const Loan&) = delete;

        BrickScratch& operator*() noexcept { return *scratch_; }

    private:
        ScratchPool& pool_;
        std::unique_ptr<BrickScratch> scratch_;
    };

    /// account: none: uncounted.
    explicit ScratchPool(std::shared_ptr<MemoryAccount> account = nullptr) : account_(std::move(account)) {}

    /// None: uncounted.
    const std::shared_ptr<MemoryAccount>& account() const noexcept { return account_; }
    /// Frees what is not on loan.
    void release_memory() {
        const std::lock_guard lock(mutex_);
        made_ -= free_.size();
        free_.clear();
    }

private:
    std::unique_ptr<BrickScratch> take() {
        const std::lock_guard lock(mutex_);
        if (free_.empty()) {
            free_.reserve(++made_);  // so that give() never allocates
            return std::make_unique<BrickScratch>(account_);
        }
        auto scratch = std::move(free_.back());
        free_.pop_back();
        return scratch;
    }
    void give(std::unique_ptr<BrickScratch> scratch) noexcept {
        const std::lock_guard lock(mutex_);
        free_.push_back(std::move(scratch));
    }

    const std::shared_ptr<MemoryAccount> account_;
    std::mutex mutex_;
    std::size_t made_ = 0;
    std::vector<std::unique_ptr<BrickScratch>> free_;
};

}  // namespace meniscus::server
