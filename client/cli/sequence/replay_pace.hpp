// When a recorded frame is due again.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace meniscus::cli {

class ReplayPace {
public:
    /// "max", or how many times as fast as recorded. Throws InvalidInput for anything else.
    explicit ReplayPace(const std::string& speed);

    /// Waits until this long after the first call, by the recording's clock; not at all if that has passed.
    void wait(std::chrono::duration<double> since_first);

private:
    double speed_ = 0.0;  ///< 0: as fast as possible
    std::optional<std::chrono::steady_clock::time_point> first_;
};

}  // namespace meniscus::cli
