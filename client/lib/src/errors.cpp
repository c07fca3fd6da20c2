#include "meniscus/client/errors.hpp"

#include <new>

namespace meniscus::client {

ErrorCode code_of(const std::exception& error) noexcept {
    if (const auto* of_server = dynamic_cast<const ServerError*>(&error)) return of_server->code();
    if (dynamic_cast<const InvalidInput*>(&error)) return ErrorCode::invalid_input;
    if (dynamic_cast<const LimitExceeded*>(&error)) return ErrorCode::limit_exceeded;
    if (dynamic_cast<const DeviceError*>(&error)) return ErrorCode::device;
    if (dynamic_cast<const Stopped*>(&error)) return ErrorCode::canceled;
    if (dynamic_cast<const NotBuilt*>(&error)) return ErrorCode::unimplemented;
    if (dynamic_cast<const std::bad_alloc*>(&error)) return ErrorCode::out_of_memory;
    return ErrorCode::unknown;
}

}  // namespace meniscus::client
