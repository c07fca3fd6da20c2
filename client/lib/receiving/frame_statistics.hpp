// A frame's figures as they come.
#pragma once

#include "conversion/statistics_conversion.hpp"
#include "meniscus/client/client.hpp"

namespace meniscus::client {

inline FrameStatistics frame_statistics(const v1::FrameStatistics& wire) {
    FrameStatistics statistics;
    static_cast<Statistics&>(statistics) = conversion::from_wire(wire);
    statistics.encode_seconds = wire.encode_seconds();
    statistics.latency_seconds = wire.latency_seconds();
    statistics.encoded_bytes = wire.encoded_bytes();
    return statistics;
}

}  // namespace meniscus::client
