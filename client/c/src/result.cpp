#include "result.hpp"

#include <array>
#include <cstddef>
#include <cstdio>
#include <new>

#include "meniscus/client/errors.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::c {
namespace {

/// An array, for it must be there when no memory is.
thread_local std::array<char, 1024> last_message{};

meniscus_result result_of(client::ErrorCode code) {
    using client::ErrorCode;
    switch (code) {
        case ErrorCode::invalid_input:
            return MENISCUS_INVALID_INPUT;
        case ErrorCode::limit_exceeded:
            return MENISCUS_LIMIT_EXCEEDED;
        case ErrorCode::not_found:
            return MENISCUS_NOT_FOUND;
        case ErrorCode::already_exists:
            return MENISCUS_ALREADY_EXISTS;
        case ErrorCode::failed_precondition:
            return MENISCUS_FAILED_PRECONDITION;
        case ErrorCode::unauthenticated:
            return MENISCUS_UNAUTHENTICATED;
        case ErrorCode::permission_denied:
            return MENISCUS_PERMISSION_DENIED;
        case ErrorCode::unavailable:
            return MENISCUS_UNAVAILABLE;
        case ErrorCode::deadline_exceeded:
            return MENISCUS_DEADLINE_EXCEEDED;
        case ErrorCode::canceled:
            return MENISCUS_CANCELED;
        case ErrorCode::aborted:
            return MENISCUS_ABORTED;
        case ErrorCode::unimplemented:
            return MENISCUS_UNIMPLEMENTED;
        case ErrorCode::data_loss:
            return MENISCUS_DATA_LOSS;
        case ErrorCode::internal:
            return MENISCUS_INTERNAL;
        case ErrorCode::device:
            return MENISCUS_DEVICE;
        case ErrorCode::out_of_memory:
            return MENISCUS_OUT_OF_MEMORY;
        case ErrorCode::unknown:
            return MENISCUS_UNKNOWN;
    }
    return MENISCUS_UNKNOWN;
}

/// The last character of a message that is too long may be cut in its middle: it goes.
void drop_cut_character() noexcept {
    std::size_t end = last_message.size() - 1;
    const auto byte = [&] { return static_cast<unsigned char>(last_message[end - 1]); };
    while (end > 1 && byte() >= 0x80 && byte() < 0xC0) --end;
    if (byte() >= 0xC0) --end;
    last_message[end] = '\0';
}

meniscus_result keep(meniscus_result result, const char* message) noexcept {
    const int length = std::snprintf(last_message.data(), last_message.size(), "%s", message);
    if (length >= static_cast<int>(last_message.size())) drop_cut_character();
    return result;
}

}  // namespace

meniscus_result failed() noexcept {
    try {
        throw;
    } catch (const std::bad_alloc&) {
        return keep(MENISCUS_OUT_OF_MEMORY, "not enough memory is left");
    } catch (const std::exception& error) {
        return keep(result_of(client::code_of(error)), error.what());
    } catch (...) {
        return keep(MENISCUS_UNKNOWN, "an exception that is none of this library's");
    }
}

}  // namespace meniscus::c

const char* meniscus_result_name(meniscus_result result) {
    switch (result) {
        case MENISCUS_OK:
            return "ok";
        case MENISCUS_NOTHING_YET:
            return "nothing_yet";
        case MENISCUS_ENDED:
            return "ended";
        case MENISCUS_WOULD_WAIT:
            return "would_wait";
        case MENISCUS_INVALID_INPUT:
            return "invalid_input";
        case MENISCUS_LIMIT_EXCEEDED:
            return "limit_exceeded";
        case MENISCUS_OUT_OF_MEMORY:
            return "out_of_memory";
        case MENISCUS_DEVICE:
            return "device";
        case MENISCUS_UNAVAILABLE:
            return "unavailable";
        case MENISCUS_NOT_FOUND:
            return "not_found";
        case MENISCUS_ALREADY_EXISTS:
            return "already_exists";
        case MENISCUS_UNAUTHENTICATED:
            return "unauthenticated";
        case MENISCUS_PERMISSION_DENIED:
            return "permission_denied";
        case MENISCUS_FAILED_PRECONDITION:
            return "failed_precondition";
        case MENISCUS_DEADLINE_EXCEEDED:
            return "deadline_exceeded";
        case MENISCUS_CANCELED:
            return "canceled";
        case MENISCUS_UNIMPLEMENTED:
            return "unimplemented";
        case MENISCUS_DATA_LOSS:
            return "data_loss";
        case MENISCUS_ABORTED:
            return "aborted";
        case MENISCUS_INTERNAL:
            return "internal";
        case MENISCUS_UNKNOWN:
            return "unknown";
    }
    return "unknown";
}

const char* meniscus_error_message(void) {
    return meniscus::c::last_message.data();
}

const char* meniscus_version(void) {
    return meniscus::version().data();
}
