#include "rpc/calls/refusals.hpp"

#include <spdlog/spdlog.h>

#include <new>
#include <string_view>

#include "meniscus/error.hpp"
#include "sessions/limits/limit_reached.hpp"
#include "sessions/limits/refusal.hpp"

namespace meniscus::server {

namespace {

struct Reason {
    std::string_view name{};  ///< empty: it is no refusal
    bool is_logged = false;   ///< what an operator may want to change
    std::string message{};
};

Reason reason_of(const Refusal& refusal) {
    switch (refusal.kind()) {
        case Refusal::Kind::not_found:
            return {.name = "not_found"};
        case Refusal::Kind::already_exists:
            return {.name = "already_exists"};
        case Refusal::Kind::failed_precondition:
            return {.name = "failed_precondition"};
        case Refusal::Kind::unauthenticated:
            return {.name = "unauthenticated", .is_logged = true, .message = refusal.what()};
        case Refusal::Kind::permission_denied:
            return {.name = "permission_denied", .is_logged = true, .message = refusal.what()};
        case Refusal::Kind::unimplemented:
            return {.name = "unimplemented"};
        case Refusal::Kind::unavailable:
        case Refusal::Kind::data_loss:
        case Refusal::Kind::aborted:
            break;
    }
    return {};
}

Reason reason_of(const std::exception_ptr& error) {
    try {
        std::rethrow_exception(error);
    } catch (const InvalidInput&) {
        return {.name = "invalid_argument"};
    } catch (const LimitReached& limit) {
        return {.name = name_of(limit.limit()), .is_logged = true, .message = limit.what()};
    } catch (const LimitExceeded& limit) {
        return {.name = "size", .is_logged = true, .message = limit.what()};
    } catch (const std::bad_alloc&) {
        return {.name = "size", .is_logged = true, .message = "the server is out of memory"};
    } catch (const Refusal& refusal) {
        return reason_of(refusal);
    } catch (...) {
        return {};  // a failure of the server
    }
}

}  // namespace

void Refusals::report(const std::exception_ptr& error, const std::string& name, const std::string& peer) {
    if (!error) return;
    const Reason reason = reason_of(error);
    if (reason.name.empty()) return;
    metrics_->refused(reason.name, name);
    if (!reason.is_logged) return;
    if (const auto kept_back = lines_.pass())
        spdlog::warn("refused{}{} at {}: {}{}", name.empty() ? "" : " to ", name, peer, reason.message,
                     left_out(*kept_back));
}

}  // namespace meniscus::server
