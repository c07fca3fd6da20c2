// The errors of the client library: ServerError, and those of the reconstruction library. A program distinguishes them
// by their codes.
#pragma once

#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "meniscus/error.hpp"

namespace meniscus::client {

/// The kind of an error. Names and meanings stay; new ones may be added.
enum class ErrorCode {
    invalid_input,        ///< InvalidInput: other input will do
    limit_exceeded,       ///< LimitExceeded: less will do, or the same later where the message says so
    not_found,            ///< no such session, recording
    already_exists,       ///< a session of this id, with other settings
    failed_precondition,  ///< not now: somebody else uploads to the session, the recording is being written
    unauthenticated,      ///< the token is missing or not known
    permission_denied,    ///< the token's role may not
    unavailable,          ///< the server is not there, went down, or the connection broke
    deadline_exceeded,    ///< the server has not answered in time
    canceled,             ///< by cancel() or a StopFlag here, or by a proxy or the server
    aborted,              ///< gives way to another call
    unimplemented,        ///< the server knows no such call: it is none, is of another version, or records nothing;
                          ///< NotBuilt: this library lacks the part
    data_loss,            ///< what came from the server makes no sense, or is damaged
    internal,             ///< a defect of the server
    device,               ///< DeviceError: a GPU failed
    out_of_memory,        ///< std::bad_alloc, here
    unknown,              ///< anything else
};
constexpr std::string_view name_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::invalid_input:
            return "invalid_input";
        case ErrorCode::limit_exceeded:
            return "limit_exceeded";
        case ErrorCode::not_found:
            return "not_found";
        case ErrorCode::already_exists:
            return "already_exists";
        case ErrorCode::failed_precondition:
            return "failed_precondition";
        case ErrorCode::unauthenticated:
            return "unauthenticated";
        case ErrorCode::permission_denied:
            return "permission_denied";
        case ErrorCode::unavailable:
            return "unavailable";
        case ErrorCode::deadline_exceeded:
            return "deadline_exceeded";
        case ErrorCode::canceled:
            return "canceled";
        case ErrorCode::aborted:
            return "aborted";
        case ErrorCode::unimplemented:
            return "unimplemented";
        case ErrorCode::data_loss:
            return "data_loss";
        case ErrorCode::internal:
            return "internal";
        case ErrorCode::device:
            return "device";
        case ErrorCode::out_of_memory:
            return "out_of_memory";
        case ErrorCode::unknown:
            return "unknown";
    }
    return {};
}

/// A call failed: the server is not there, refused, or went away. (Refusals of input are InvalidInput and
/// LimitExceeded, as in process.)
class ServerError : public std::runtime_error {
public:
    /// status: gRPC's name of it, such as "UNAVAILABLE"; empty for what this library has found wrong.
    explicit ServerError(const std::string& message, ErrorCode code = ErrorCode::data_loss, std::string status = {})
        : std::runtime_error(message), code_(code), status_(std::move(status)) {}
    ErrorCode code() const noexcept { return code_; }
    const std::string& status() const noexcept { return status_; }

private:
    ErrorCode code_;
    std::string status_;
};

/// The code of any exception of this library or of the reconstruction library.
ErrorCode code_of(const std::exception& error) noexcept;

}  // namespace meniscus::client
