#include "rpc/calls/status.hpp"

#include <spdlog/spdlog.h>

#include <new>
#include <system_error>

#include "meniscus/error.hpp"
#include "sessions/limits/refusal.hpp"

namespace meniscus::server {

namespace {

grpc::StatusCode code_of(Refusal::Kind kind) {
    switch (kind) {
        case Refusal::Kind::not_found:
            return grpc::StatusCode::NOT_FOUND;
        case Refusal::Kind::already_exists:
            return grpc::StatusCode::ALREADY_EXISTS;
        case Refusal::Kind::failed_precondition:
            return grpc::StatusCode::FAILED_PRECONDITION;
        case Refusal::Kind::unavailable:
            return grpc::StatusCode::UNAVAILABLE;
        case Refusal::Kind::unauthenticated:
            return grpc::StatusCode::UNAUTHENTICATED;
        case Refusal::Kind::permission_denied:
            return grpc::StatusCode::PERMISSION_DENIED;
        case Refusal::Kind::unimplemented:
            return grpc::StatusCode::UNIMPLEMENTED;
        case Refusal::Kind::data_loss:
            return grpc::StatusCode::DATA_LOSS;
        case Refusal::Kind::aborted:
            return grpc::StatusCode::ABORTED;
    }
    return grpc::StatusCode::INTERNAL;
}

}  // namespace

grpc::Status to_status(const std::exception_ptr& error) {
    if (!error) return grpc::Status::OK;
    try {
        std::rethrow_exception(error);
    } catch (const InvalidInput& e) {
        return {grpc::StatusCode::INVALID_ARGUMENT, e.what()};
    } catch (const LimitExceeded& e) {
        return {grpc::StatusCode::RESOURCE_EXHAUSTED, e.what()};
    } catch (const Refusal& e) {
        return {code_of(e.kind()), e.what()};
    } catch (const DeviceError& e) {
        return {grpc::StatusCode::INTERNAL, e.what()};
    } catch (const std::bad_alloc&) {
        return {grpc::StatusCode::RESOURCE_EXHAUSTED, "the server is out of memory"};
    } catch (const std::system_error& e) {
        if (e.code() == std::errc::resource_unavailable_try_again)
            return {
                grpc::StatusCode::RESOURCE_EXHAUSTED,
                "the server cannot start another thread: it needs a higher limit of threads (ulimit -u, TasksMax of "
                "systemd, pids of a container) or fewer sessions"};
        spdlog::error("internal error: {}", e.what());
        return {grpc::StatusCode::INTERNAL, e.what()};
    } catch (const std::exception& e) {
        spdlog::error("internal error: {}", e.what());
        return {grpc::StatusCode::INTERNAL, e.what()};
    }
}

grpc::Status client_gone() {
    return {grpc::StatusCode::CANCELLED, "the client has gone"};
}

}  // namespace meniscus::server
