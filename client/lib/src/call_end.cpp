#include "call_end.hpp"

#include <map>

namespace meniscus::client {

namespace {

std::string instance_in(const std::multimap<grpc::string_ref, grpc::string_ref>& metadata) {
    const auto found = metadata.find("x-server-instance");
    return found == metadata.end() ? std::string() : std::string(found->second.data(), found->second.size());
}

}  // namespace

std::string accepted_by(const grpc::ClientContext& context) {
    return instance_in(context.GetServerInitialMetadata());
}

std::string ended_by(const grpc::ClientContext& context) {
    return instance_in(context.GetServerTrailingMetadata());
}

bool may_go_on(const grpc::Status& status, const grpc::ClientContext& context) {
    switch (status.error_code()) {
        case grpc::StatusCode::UNAVAILABLE:
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

}  // namespace meniscus::client
