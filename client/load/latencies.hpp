// Latencies, every one of them kept: percentiles are exact.
#pragma once

#include <cstddef>
#include <vector>

namespace meniscus::load {

class Latencies {
public:
    void add(double seconds) { seconds_.push_back(seconds); }
    void add(const Latencies& more) { seconds_.insert(seconds_.end(), more.seconds_.begin(), more.seconds_.end()); }

    std::size_t count() const { return seconds_.size(); }
    /// Seconds; 0 if there are none, as below.
    double mean() const;
    /// The smallest that at least this share (0 to 1) of all do not exceed; 1 gives the largest.
    double percentile(double share) const;

private:
    std::vector<double> seconds_;
};

}  // namespace meniscus::load
