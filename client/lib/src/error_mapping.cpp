#include "error_mapping.hpp"

#include <algorithm>
#include <array>

#include "meniscus/client/errors.hpp"

namespace meniscus::client {

namespace {

struct Meaning {
    grpc::StatusCode status;
    const char* name;  ///< as gRPC writes it
    ErrorCode code;
    const char* words;
};

/// InvalidInput and LimitExceeded stand for the two that are not here.
constexpr std::array meanings{
    Meaning{grpc::StatusCode::CANCELLED, "CANCELLED", ErrorCode::canceled, "canceled"},
    Meaning{grpc::StatusCode::DEADLINE_EXCEEDED, "DEADLINE_EXCEEDED", ErrorCode::deadline_exceeded, "too late"},
    Meaning{grpc::StatusCode::NOT_FOUND, "NOT_FOUND", ErrorCode::not_found, "not found"},
    Meaning{grpc::StatusCode::ALREADY_EXISTS, "ALREADY_EXISTS", ErrorCode::already_exists, "already exists"},
    Meaning{grpc::StatusCode::PERMISSION_DENIED, "PERMISSION_DENIED", ErrorCode::permission_denied, "not allowed"},
    Meaning{grpc::StatusCode::UNAUTHENTICATED, "UNAUTHENTICATED", ErrorCode::unauthenticated, "not let in"},
    Meaning{grpc::StatusCode::FAILED_PRECONDITION, "FAILED_PRECONDITION", ErrorCode::failed_precondition,
            "not possible now"},
    Meaning{grpc::StatusCode::ABORTED, "ABORTED", ErrorCode::aborted, "aborted"},
    Meaning{grpc::StatusCode::UNIMPLEMENTED, "UNIMPLEMENTED", ErrorCode::unimplemented, "not offered"},
    Meaning{grpc::StatusCode::INTERNAL, "INTERNAL", ErrorCode::internal, "internal error of the server"},
    Meaning{grpc::StatusCode::UNAVAILABLE, "UNAVAILABLE", ErrorCode::unavailable, "not available"},
    Meaning{grpc::StatusCode::DATA_LOSS, "DATA_LOSS", ErrorCode::data_loss, "data are damaged"},
};

ServerError server_error(const grpc::Status& status, const std::string& address) {
    const std::string& message = status.error_message();
    const auto meaning = std::find_if(meanings.begin(), meanings.end(),
                                      [&](const Meaning& one) { return one.status == status.error_code(); });
    if (meaning == meanings.end())
        return ServerError("the server at " + address + ": " + message + " (gRPC status " +
                               std::to_string(static_cast<int>(status.error_code())) + ")",
                           ErrorCode::unknown, "UNKNOWN");
    if (meaning->code == ErrorCode::unavailable) {
        // gRPC's words for a ping that is not answered, and for bytes that are not taken.
        const bool is_silent = message == "keepalive watchdog timeout" || message == "recvmsg:Connection timed out";
        const std::string reason = is_silent ? "it answers nothing" : message;
        return ServerError(
            "the server at " + address + " is not available (" + reason + "): restart meniscusd or check the address",
            meaning->code, meaning->name);
    }
    return ServerError("the server at " + address + ": " + message + " (" + meaning->words + ")", meaning->code,
                       meaning->name);
}

}  // namespace

std::exception_ptr to_exception(const grpc::Status& status, const std::string& address) {
    if (status.error_code() == grpc::StatusCode::INVALID_ARGUMENT)
        return std::make_exception_ptr(InvalidInput(status.error_message()));
    if (status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED)
        return std::make_exception_ptr(LimitExceeded(status.error_message()));
    return std::make_exception_ptr(server_error(status, address));
}

void require_ok(const grpc::Status& status, const std::string& address) {
    if (!status.ok()) std::rethrow_exception(to_exception(status, address));
}

}  // namespace meniscus::client
