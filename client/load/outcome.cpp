#include "load/outcome.hpp"

#include <algorithm>

#include "meniscus/client/client.hpp"
#include "meniscus/error.hpp"

namespace meniscus::load {

namespace {

std::string status_of(const std::exception_ptr& error) {
    try {
        std::rethrow_exception(error);
    } catch (const InvalidInput&) {
        return "INVALID_ARGUMENT";
    } catch (const LimitExceeded&) {
        return "RESOURCE_EXHAUSTED";
    } catch (const client::ServerError& e) {
        return e.status().empty() ? "CLIENT" : e.status();
    } catch (const std::exception&) {
        return "CLIENT";
    }
}

void add_errors(Errors& errors, const Errors& more) {
    for (const auto& [status, count] : more) errors[status] += count;
}

}  // namespace

void count_error(Errors& errors, const std::exception_ptr& error) {
    ++errors[status_of(error)];
}

void UploadOutcome::add(const UploadOutcome& more) {
    answer.add(more.answer);
    send_delay.add(more.send_delay);
    sent += more.sent;
    answered += more.answered;
    dropped += more.dropped;
    not_sent += more.not_sent;
    particles += more.particles;
    upload_bytes += more.upload_bytes;
    mesh_bytes += more.mesh_bytes;
    last_answer = std::max(last_answer, more.last_answer);
    add_errors(errors, more.errors);
}

void WatchOutcome::add(const WatchOutcome& more) {
    latency.add(more.latency);
    frames += more.frames;
    skipped += more.skipped;
    vanished += more.vanished;
    mesh_bytes += more.mesh_bytes;
    add_errors(errors, more.errors);
}

}  // namespace meniscus::load
