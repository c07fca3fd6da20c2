#include "call_end.hpp"

#include <map>

namespace meniscus::client {

namespace {

using Metadata = std::multimap<grpc::string_ref, grpc::string_ref>;

std::string value_in(const Metadata& metadata, const char* key) {
    const auto found = metadata.find(key);
    return found == metadata.end() ? std::string() : std::string(found->second.data(), found->second.size());
}

}  // namespace

std::string accepted_by(const grpc::ClientContext& context) {
    return value_in(context.GetServerInitialMetadata(), "x-server-instance");
}

std::string ended_by(const grpc::ClientContext& context) {
    return value_in(context.GetServerTrailingMetadata(), "x-server-instance");
}

bool can_reconnect_after(const grpc::Status& status, const grpc::ClientContext& context) {
    switch (status.error_code()) {
        case grpc::StatusCode::UNAVAILABLE:
        case grpc::StatusCode::ABORTED:            // another part of the frames has broken off
        case grpc::StatusCode::CANCELLED:          // by a proxy, or a server that did not wait any longer
        case grpc::StatusCode::UNKNOWN:            // gRPC's word for some broken connections
        case grpc::StatusCode::DEADLINE_EXCEEDED:  // of an attempt
            return true;
        case grpc::StatusCode::INTERNAL:  // a proxy's stream that was reset; from a server: something has failed there
            return ended_by(context).empty();
        default:
            return false;
    }
}

std::string session_end_of(const grpc::ClientContext& context) {
    return value_in(context.GetServerTrailingMetadata(), "x-session-end");
}

bool ended_for_idleness(const grpc::ClientContext& context) {
    return value_in(context.GetServerTrailingMetadata(), "x-stream-end") == "idle";
}

}  // namespace meniscus::client
