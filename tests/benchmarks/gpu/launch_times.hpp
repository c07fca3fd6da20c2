// The launches of a frame, and the time of each on the GPU, by an event before and behind it, in a queue that is full.
#pragma once

#include <cstddef>
#include <deque>
#include <exception>
#include <vector>

#include "engine/cuda/launch_observer.hpp"
#include "engine/cuda/stream.hpp"
#include "gpu/full_queue.hpp"

namespace meniscus::benchmarks {

class LaunchTimes final : public cuda::LaunchObserver {
public:
    enum class What : std::uint8_t { kernels_and_calls, graphs };

    /// Times this thread's launches until the end of this object.
    explicit LaunchTimes(What what) : what_(what) { cuda::launch_observer = this; }
    ~LaunchTimes() { cuda::launch_observer = nullptr; }
    LaunchTimes(const LaunchTimes&) = delete;
    LaunchTimes& operator=(const LaunchTimes&) = delete;

    struct Timed {
        cuda::Launch launch;
        cuda::Event begin, end;
    };

    void before(const cuda::Launch& launch) override {
        if (!is_wanted(launch)) return;
        // Else what lies between two events would hold the host's launch, where the GPU is ahead of it.
        if (used_ == 0 || launch.stream != timed_[used_ - 1].launch.stream) keep_busy(launch.stream);
        if (used_ == timed_.size()) timed_.emplace_back();
        timed_[used_].launch = launch;
        timed_[used_].begin.record(launch.stream);
    }
    void after(const cuda::Launch& launch) noexcept override {
        if (!is_wanted(launch)) return;
        try {
            timed_[used_++].end.record(launch.stream);
        } catch (const std::exception&) {
            // The device has failed: the launch itself reports that, or the wait for it.
        }
    }

    /// Forgets what was launched.
    void clear() { used_ = 0; }
    std::size_t count() const { return used_; }
    const cuda::Launch& launch(std::size_t i) const { return timed_[i].launch; }
    /// Once the stream has been waited for.
    double seconds(std::size_t i) const { return timed_[i].end.seconds_since(timed_[i].begin); }
    /// From the first launch's begin to the last one's end.
    double seconds() const { return used_ == 0 ? 0.0 : timed_[used_ - 1].end.seconds_since(timed_[0].begin); }

private:
    bool is_wanted(const cuda::Launch& launch) const {
        return (launch.kind == cuda::LaunchKind::graph) == (what_ == What::graphs);
    }

    What what_;
    std::deque<Timed> timed_;  ///< events are made once
    std::size_t used_ = 0;
};

}  // namespace meniscus::benchmarks
