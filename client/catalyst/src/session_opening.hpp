// Opens a session on a thread of its own, again and again until the server is there: the simulation does not wait.
#pragma once

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "handles.hpp"
#include "text_options/option_reader.hpp"

namespace meniscus::catalyst {

class SessionOpening {
public:
    /// again: what a server refuses is tried again, too, since it has taken the same options before.
    SessionOpening(std::string server, text_options::Options connection, text_options::Options session, bool again);
    ~SessionOpening();  ///< waits for an attempt that is under way, for the option "timeout" at most

    enum class State { trying, away, refused, open };
    /// After the first attempt: not `trying`.
    State first_attempt();
    State state() const;
    /// Of the last attempt that failed.
    std::string message() const;
    meniscus_result result() const;
    /// The session that is open.
    Session take();

private:
    void run(const std::stop_token& stop);
    /// Returns the session's, or the client's, result and keeps its message.
    State attempt();

    const std::string server_;
    const text_options::Options connection_options_;
    const text_options::Options session_options_;
    const bool again_;
    Client client_;  ///< the thread's

    mutable std::mutex mutex_;
    std::condition_variable_any changed_;
    State state_ = State::trying;
    std::string message_;
    meniscus_result result_ = MENISCUS_OK;
    Session session_;
    std::jthread thread_;  ///< goes first
};

}  // namespace meniscus::catalyst
