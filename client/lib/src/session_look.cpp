#include "session_look.hpp"

#include <algorithm>
#include <utility>

namespace meniscus::client {

void wait_for_connection(grpc::ClientContext& context, std::chrono::steady_clock::time_point give_up_at) {
    using Time = std::chrono::steady_clock;
    constexpr std::chrono::seconds attempt_time{5};
    context.set_wait_for_ready(true);
    const auto left = std::min<Time::duration>(attempt_time, give_up_at - Time::now());
    context.set_deadline(std::chrono::system_clock::now() +
                         std::chrono::duration_cast<std::chrono::system_clock::duration>(left));
}

grpc::Status get_session(const Connection& connection, grpc::ClientContext& context, const std::string& session_id,
                         v1::Session& session) {
    connection.add_metadata(context, session_id);
    v1::GetSessionRequest request;
    request.set_id(session_id);
    v1::GetSessionResponse response;
    grpc::Status status = connection.sessions->GetSession(&context, request, &response);
    session = std::move(*response.mutable_session());
    return status;
}

}  // namespace meniscus::client
