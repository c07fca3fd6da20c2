// A stream, as far as it sends a frame to the bytes in flight.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

#include "sessions/limits/bytes_in_flight.hpp"

namespace meniscus::server::test {

/// Each part of the frame is booked when it has arrived, or the stream waits.
struct Sender {
    explicit Sender(const std::shared_ptr<BytesInFlight>& all,
                    std::shared_ptr<SessionInFlight> session = std::make_shared<SessionInFlight>())
        : frame(all, std::move(session)) {}

    void begin(std::size_t bytes) {
        announced = bytes;
        arrived = 0;
        frame.announce(bytes);
        book();
    }
    /// Returns whether more may come.
    bool arrive(std::size_t bytes) {
        arrived = std::min(arrived + bytes, announced);
        return book();
    }
    bool book() {
        waits = true;
        if (frame.book(arrived, [this] { waits = false; })) waits = false;
        return !waits;
    }
    bool whole() const { return !waits && arrived == announced; }

    FrameInFlight frame;
    std::size_t announced = 0;
    std::size_t arrived = 0;
    bool waits = false;
};

}  // namespace meniscus::server::test
