#include "recording/recording_reads.hpp"

#include <fmt/format.h>

#include <boost/asio/post.hpp>
#include <utility>

#include "sessions/limits/limit_reached.hpp"
#include "sessions/limits/refusal.hpp"

namespace meniscus::server {

RecordingReads::RecordingReads(std::filesystem::path directory, std::uint32_t readers,
                               std::chrono::milliseconds patience)
    : limit_(readers), patience_(patience), catalog_(std::move(directory)) {}

RecordingReads::~RecordingReads() {
    // Before the timer goes, which a scan under way sets.
    thread_.stop();
    thread_.join();
}

RecordingReads::Place RecordingReads::admit() {
    require_going_on();
    const std::uint32_t others = readers_++;
    Place place(&readers_, [](void* readers) { --*static_cast<std::atomic<std::uint32_t>*>(readers); });
    if (limit_ != 0 && others >= limit_)
        throw LimitReached(LimitName::recording_readers,
                           fmt::format("{} recordings are being read; the server takes at most {} readers at a time "
                                       "(--max-recording-readers): try again later",
                                       others, limit_));
    return place;
}

void RecordingReads::post(std::function<void(RecordingCatalog&)> job) {
    boost::asio::post(thread_, [this, job = std::move(job)] { job(catalog_); });
}

void RecordingReads::post_scan(std::function<void(RecordingCatalog&)> job) {
    boost::asio::post(thread_, [this, job = std::move(job)]() mutable {
        scans_.push_back(std::move(job));
        if (scans_.size() == 1) wait_to_scan();
    });
}

void RecordingReads::wait_to_scan() {
    // Where the server ends, there is no pause, and the job finds out.
    if (ending_) next_scan_.expires_at(std::chrono::steady_clock::now());
    next_scan_.async_wait([this](const boost::system::error_code&) {
        const auto begun = std::chrono::steady_clock::now();
        scans_.front()(catalog_);
        const auto end = std::chrono::steady_clock::now();
        scans_.pop_front();
        next_scan_.expires_at(end + (end - begun));
        if (!scans_.empty()) wait_to_scan();
    });
}

void RecordingReads::end() {
    ending_ = true;
    boost::asio::post(thread_, [this] { next_scan_.cancel(); });
}

void RecordingReads::require_going_on() const {
    if (ending_) throw shutting_down();
}

}  // namespace meniscus::server
