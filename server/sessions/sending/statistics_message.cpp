#include "sessions/sending/statistics_message.hpp"

#include "conversion/statistics_conversion.hpp"

namespace meniscus::server {

v1::FrameStatistics statistics_message(const FrameStatistics& statistics) {
    v1::FrameStatistics message;
    conversion::to_wire(statistics, message);
    message.set_frame_index(statistics.frame_index);
    message.set_simulation_time(statistics.simulation_time);
    message.set_encode_seconds(statistics.encode_seconds);
    message.set_latency_seconds(statistics.latency_seconds);
    message.set_encoded_bytes(statistics.encoded_bytes);
    return message;
}

}  // namespace meniscus::server
