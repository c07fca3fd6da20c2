// Latencies. Each one is kept, so that percentiles are exact.
#pragma once

#include <cstddef>
#include <vector>

namespace meniscus::load {

class Latencies {
public:
    void add(double seconds) { seconds_.push_back(seconds); }
    void add(const Latencies& more) { seconds_.insert(seconds_.end(), more.seconds_.begin(), more.seconds_.end()); }

    std::size_t count() const { return seconds_.size(); }
    /// Seconds, as all results here; 0 without latencies.
    double mean() const;
    /// The smallest latency that at least this share (0 to 1) of all latencies does not exceed; 1 gives the largest.
    double percentile(double share) const;

private:
    std::vector<double> seconds_;
};

}  // namespace meniscus::load
