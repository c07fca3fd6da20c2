#include "cli/sequence/work_in_turn.hpp"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace meniscus::cli {
namespace {

/// Thrown through a worker whose turn will not come.
struct Ended {};

class Turns {
public:
    explicit Turns(std::size_t count) : count_(count) {}

    /// None: there are none left, or one has failed.
    std::optional<std::size_t> take() {
        const std::lock_guard lock(mutex_);
        if (error_ || taken_ == count_) return std::nullopt;
        return taken_++;
    }
    void wait(std::size_t item) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return error_ || done_ == item; });
        if (error_) throw Ended();
    }
    void finish() {
        {
            const std::lock_guard lock(mutex_);
            ++done_;
        }
        changed_.notify_all();
    }
    void fail(std::exception_ptr error) {
        {
            const std::lock_guard lock(mutex_);
            error_ = std::move(error);
        }
        changed_.notify_all();
    }
    std::exception_ptr error() const { return error_; }

private:
    const std::size_t count_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::size_t taken_ = 0;
    std::size_t done_ = 0;
    std::exception_ptr error_;  ///< of item `done_`
};

void work_on(Turns& turns, const Work& work) {
    try {
        while (const auto item = turns.take()) {
            std::exception_ptr error;
            try {
                work(*item, [&] { turns.wait(*item); });
            } catch (const Ended&) {
                throw;
            } catch (...) {
                error = std::current_exception();
            }
            // An error of an item is none as long as one before it may fail.
            turns.wait(*item);
            if (error) return turns.fail(std::move(error));
            turns.finish();
        }
    } catch (const Ended&) {
    }
}

}  // namespace

void work_in_turn(std::size_t count, std::span<const Work> workers) {
    Turns turns(count);
    {
        std::vector<std::jthread> threads;
        for (const Work& work : workers.subspan(1)) threads.emplace_back([&] { work_on(turns, work); });
        work_on(turns, workers.front());
    }
    if (turns.error()) std::rethrow_exception(turns.error());
}

}  // namespace meniscus::cli
