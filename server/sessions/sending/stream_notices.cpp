#include "sessions/sending/stream_notices.hpp"

#include <string>

#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::server {

namespace {

// One serialization serves both RPCs.
static_assert(int{v1::StreamResponse::kDrainingFieldNumber} == int{v1::WatchResponse::kDrainingFieldNumber});

v1::DropReason to_wire(DropReason reason) {
    switch (reason) {
        case DropReason::replaced:
            return v1::DROP_REASON_REPLACED;
        case DropReason::not_nth:
            return v1::DROP_REASON_NOT_NTH;
        case DropReason::incomplete:
            return v1::DROP_REASON_INCOMPLETE;
    }
    return v1::DROP_REASON_UNSPECIFIED;
}

}  // namespace

SharedMessage frame_dropped_message(const DroppedFrame& frame) {
    v1::StreamResponse response;
    response.mutable_frame_dropped()->set_frame_index(frame.index);
    response.mutable_frame_dropped()->set_reason(to_wire(frame.reason));
    return std::make_shared<const std::string>(response.SerializeAsString());
}

SharedMessage draining_message(std::chrono::duration<double> grace) {
    v1::StreamResponse response;
    response.mutable_draining()->set_seconds(grace.count());
    return std::make_shared<const std::string>(response.SerializeAsString());
}

}  // namespace meniscus::server
