#include "error_mapping.hpp"

#include "meniscus/client/client.hpp"
#include "meniscus/error.hpp"

namespace meniscus::client {

namespace {

std::string code_name(grpc::StatusCode code) {
    switch (code) {
        case grpc::StatusCode::CANCELLED:
            return "canceled";
        case grpc::StatusCode::NOT_FOUND:
            return "not found";
        case grpc::StatusCode::ALREADY_EXISTS:
            return "already exists";
        case grpc::StatusCode::FAILED_PRECONDITION:
            return "not possible now";
        case grpc::StatusCode::UNIMPLEMENTED:
            return "not a meniscusd, or one of another version";
        case grpc::StatusCode::INTERNAL:
            return "internal error of the server";
        default:
            return "gRPC status " + std::to_string(static_cast<int>(code));
    }
}

}  // namespace

std::exception_ptr to_exception(const grpc::Status& status, const std::string& address) {
    const std::string& message = status.error_message();
    switch (status.error_code()) {
        case grpc::StatusCode::INVALID_ARGUMENT:
            return std::make_exception_ptr(InvalidInput(message));
        case grpc::StatusCode::RESOURCE_EXHAUSTED:
            return std::make_exception_ptr(LimitExceeded(message));
        case grpc::StatusCode::UNAVAILABLE:
            return std::make_exception_ptr(ServerError("the server at " + address + " is not available (" + message +
                                                       "): restart meniscusd or check the address"));
        default:
            return std::make_exception_ptr(ServerError("the server at " + address + ": " + message + " (" +
                                                       code_name(status.error_code()) + ")"));
    }
}

void require_ok(const grpc::Status& status, const std::string& address) {
    if (!status.ok()) std::rethrow_exception(to_exception(status, address));
}

}  // namespace meniscus::client
