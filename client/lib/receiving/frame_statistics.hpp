// A frame's figures as they come.
#pragma once

#include <string_view>

#include "conversion/statistics_conversion.hpp"
#include "meniscus/client/client.hpp"
#include "rows/message_rows.hpp"

namespace meniscus::client {

inline FrameStatistics frame_statistics(const v1::FrameStatistics& wire) {
    FrameStatistics statistics;
    static_cast<Statistics&>(statistics) = conversion::from_wire(wire);
    rows::fill_record(wire, statistics, [](std::string_view, int) {});
    return statistics;
}

}  // namespace meniscus::client
