// The present work of the process, in words: for the line about work that an end left unfinished.
#pragma once

#include <list>
#include <mutex>
#include <string>
#include <utility>

namespace meniscus::server {

/// Thread-safe.
class OpenWork {
public:
    /// Held by work from its beginning to its end.
    class Entry {
    public:
        Entry(OpenWork& board, std::string words) : board_(board) {
            const std::lock_guard lock(board_.mutex_);
            place_ = board_.entries_.insert(board_.entries_.end(), std::move(words));
        }
        ~Entry() {
            const std::lock_guard lock(board_.mutex_);
            board_.entries_.erase(place_);
        }
        Entry(const Entry&) = delete;
        Entry& operator=(const Entry&) = delete;

    private:
        OpenWork& board_;
        std::list<std::string>::iterator place_;
    };

    /// Separated by commas; empty if there is none.
    std::string text() const {
        const std::lock_guard lock(mutex_);
        std::string all;
        for (const std::string& words : entries_) all += (all.empty() ? "" : ", ") + words;
        return all;
    }

private:
    mutable std::mutex mutex_;
    std::list<std::string> entries_;  ///< the oldest first
};

/// The open work of this process.
OpenWork& open_work();

}  // namespace meniscus::server
