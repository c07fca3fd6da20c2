// How long to wait before a broken connection is tried again.
#pragma once

#include <algorithm>
#include <chrono>
#include <random>

namespace meniscus::client {

/// Doubles from 50 ms to half a second, each wait cut at random by up to a half, so that the clients of a server that
/// comes back do not all come at once. No longer, since a client behind a proxy finds its server by such attempts
/// alone.
class Backoff {
public:
    std::chrono::milliseconds next() {
        std::uniform_int_distribution<std::chrono::milliseconds::rep> cut(wait_.count() / 2, wait_.count());
        const std::chrono::milliseconds wait(cut(random_));
        wait_ = std::min(2 * wait_, longest);
        return wait;
    }
    /// Begins again with the shortest wait, after a success.
    void reset() { wait_ = shortest; }

private:
    static constexpr std::chrono::milliseconds shortest{50};
    static constexpr std::chrono::milliseconds longest{500};

    std::chrono::milliseconds wait_ = shortest;
    std::minstd_rand random_{std::random_device{}()};
};

}  // namespace meniscus::client
