// The table of bad input: what a client does, and the status that it gets for it.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "running_server.hpp"

namespace meniscus::server::test {

inline constexpr auto ok = grpc::StatusCode::OK;
inline constexpr auto invalid = grpc::StatusCode::INVALID_ARGUMENT;
inline const std::string no_session = "00000000-0000-4000-8000-000000000000";

/// Index of the good frame that a stream has sent before what is bad.
inline constexpr std::uint64_t good_frame = 10;

struct BadInputCase {
    std::string name;
    grpc::StatusCode code;  ///< OK, or that of the next check, for what lies exactly on a limit
    std::string message;    ///< a part of the status message
    std::function<grpc::Status(RunningServer&)> attempt;
};

/// For GoogleTest.
inline void PrintTo(const BadInputCase& bad, std::ostream* out) {
    *out << bad.name;
}

/// The limits of the server that all cases run against. It records into the folder.
ServerOptions bad_input_options(const std::filesystem::path& recordings);

// The table, by what is wrong.
std::vector<BadInputCase> message_order_cases();
std::vector<BadInputCase> frame_cases();
std::vector<BadInputCase> array_cases();
std::vector<BadInputCase> position_cases();
std::vector<BadInputCase> open_cases();
std::vector<BadInputCase> part_cases();
std::vector<BadInputCase> watch_cases();
std::vector<BadInputCase> session_cases();
std::vector<BadInputCase> recording_cases();

/// A session for as long as the case needs it.
struct CaseSession {
    explicit CaseSession(RunningServer& on) : running(on), id(on.session()) {}
    ~CaseSession() { running.client.delete_session(id); }
    CaseSession(const CaseSession&) = delete;
    CaseSession& operator=(const CaseSession&) = delete;

    RunningServer& running;
    const std::string id;
};

inline client::Connection connect(const RunningServer& running) {
    return client::Connection(running.server.address());
}

/// The status of a new session's stream with these messages after a good frame, which must be answered.
std::function<grpc::Status(RunningServer&)> after_a_good_frame(std::function<void(RawStream&)> send);

/// The begin of the frame after the good one, of float32 positions.
v1::StreamRequest frame_begin(std::uint64_t particles, bool has_levels = false);
v1::StreamRequest chunk_of(std::string bytes);

/// A message whose field of this number holds these bytes, whatever they are.
template <class Message>
Message with_raw_field(int field, std::string bytes) {
    Message message;
    message.GetReflection()->MutableUnknownFields(&message)->AddLengthDelimited(field, std::move(bytes));
    return message;
}

}  // namespace meniscus::server::test
