#include "session_opening.hpp"

#include <chrono>
#include <utility>

#include "c_options.hpp"
#include "server_away.hpp"

namespace meniscus::catalyst {
namespace {

/// A connection that is refused costs next to nothing.
constexpr std::chrono::seconds between_attempts(1);

}  // namespace

SessionOpening::SessionOpening(std::string server, text_options::Options connection, text_options::Options session,
                               bool again)
    : server_(std::move(server)),
      connection_options_(std::move(connection)),
      session_options_(std::move(session)),
      again_(again),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

SessionOpening::~SessionOpening() = default;

void SessionOpening::run(const std::stop_token& stop) {
    for (;;) {
        const State reached = attempt();
        std::unique_lock lock(mutex_);
        state_ = reached;
        changed_.notify_all();
        if (reached != State::away) return;
        changed_.wait_for(lock, stop, between_attempts, [] { return false; });
        if (stop.stop_requested()) return;
    }
}

SessionOpening::State SessionOpening::attempt() {
    meniscus_result result = MENISCUS_OK;
    Session session;
    if (client_ == nullptr) {
        meniscus_client* made = nullptr;
        result = meniscus_client_connect(server_.c_str(), c_options(connection_options_).get(), &made);
        client_.reset(made);
    }
    if (result == MENISCUS_OK) {
        meniscus_session* made = nullptr;
        result = meniscus_session_open(client_.get(), c_options(session_options_).get(), &made);
        session.reset(made);
    }
    const std::lock_guard lock(mutex_);
    result_ = result;
    session_ = std::move(session);
    if (result == MENISCUS_OK) return State::open;
    message_ = meniscus_error_message();
    return again_ || is_away(result) ? State::away : State::refused;
}

SessionOpening::State SessionOpening::first_attempt() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return state_ != State::trying; });
    return state_;
}

SessionOpening::State SessionOpening::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

std::string SessionOpening::message() const {
    const std::lock_guard lock(mutex_);
    return message_;
}

meniscus_result SessionOpening::result() const {
    const std::lock_guard lock(mutex_);
    return result_;
}

Session SessionOpening::take() {
    const std::lock_guard lock(mutex_);
    return std::move(session_);
}

}  // namespace meniscus::catalyst
