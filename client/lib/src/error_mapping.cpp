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
        case grpc::StatusCode::UNAUTHENTICATED:
            return "not known";
        case grpc::StatusCode::PERMISSION_DENIED:
            return "not allowed";
        case grpc::StatusCode::UNIMPLEMENTED:
            return "not a meniscusd, or one of another version";
        case grpc::StatusCode::INTERNAL:
            return "internal error of the server";
        default:
            return "gRPC status " + std::to_string(static_cast<int>(code));
    }
}

/// As gRPC writes it. InvalidInput and LimitExceeded stand for the two that are not here.
std::string status_name(grpc::StatusCode code) {
    switch (code) {
        case grpc::StatusCode::CANCELLED:
            return "CANCELLED";
        case grpc::StatusCode::DEADLINE_EXCEEDED:
            return "DEADLINE_EXCEEDED";
        case grpc::StatusCode::NOT_FOUND:
            return "NOT_FOUND";
        case grpc::StatusCode::ALREADY_EXISTS:
            return "ALREADY_EXISTS";
        case grpc::StatusCode::PERMISSION_DENIED:
            return "PERMISSION_DENIED";
        case grpc::StatusCode::UNAUTHENTICATED:
            return "UNAUTHENTICATED";
        case grpc::StatusCode::FAILED_PRECONDITION:
            return "FAILED_PRECONDITION";
        case grpc::StatusCode::ABORTED:
            return "ABORTED";
        case grpc::StatusCode::UNIMPLEMENTED:
            return "UNIMPLEMENTED";
        case grpc::StatusCode::INTERNAL:
            return "INTERNAL";
        case grpc::StatusCode::UNAVAILABLE:
            return "UNAVAILABLE";
        default:
            return "UNKNOWN";
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
                                                           "): restart meniscusd or check the address",
                                                       status_name(status.error_code())));
        default:
            return std::make_exception_ptr(
                ServerError("the server at " + address + ": " + message + " (" + code_name(status.error_code()) + ")",
                            status_name(status.error_code())));
    }
}

void require_ok(const grpc::Status& status, const std::string& address) {
    if (!status.ok()) std::rethrow_exception(to_exception(status, address));
}

}  // namespace meniscus::client
