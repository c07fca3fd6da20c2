// A simulator that never ends, with frames of one particle.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "meniscus/client/client.hpp"

namespace meniscus::soak {

class TinyFrames {
public:
    explicit TinyFrames(const std::string& server);

    /// Sends `frames`, some at a time, and waits until each is answered. Throws the error that the stream ends with, or
    /// std::runtime_error for an answer that is not the next.
    void send(std::uint64_t frames);

private:
    void push();
    void expect_answer();

    client::Client client_;
    client::Stream stream_;
    const std::vector<float> position_{0.0F, 0.0F, 0.0F};
    std::uint64_t sent_ = 0;
    std::uint64_t answered_ = 0;
};

}  // namespace meniscus::soak
