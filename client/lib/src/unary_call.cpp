#include "unary_call.hpp"

namespace meniscus::client {

grpc::Status not_answered(std::chrono::milliseconds timeout) {
    return {grpc::StatusCode::DEADLINE_EXCEEDED,
            "no answer within " + std::to_string(timeout.count()) + " ms; is it overloaded, or stopped?"};
}

}  // namespace meniscus::client
