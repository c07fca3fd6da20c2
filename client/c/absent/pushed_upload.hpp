// An upload in a build without the service: `meniscus push` speaks to the server.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "frame_bytes.hpp"
#include "meniscus/meniscus.h"
#include "push_options.hpp"
#include "push_process.hpp"
#include "text_options/option_reader.hpp"

struct meniscus_client {
    std::string program;
    std::string address;
    meniscus::text_options::Options connection;
};

namespace meniscus::c {

class PushedUpload {
public:
    /// Starts the program, writes the beginning of what it is to read, and waits for its session. Throws
    /// client::ServerError, or what the program says.
    PushedUpload(const meniscus_client& client, const PushArguments& arguments, const std::string& beginning);

    const std::string& session_id() const { return id_; }
    /// Throws InvalidInput unless the index is above the one before, and the time finite.
    void require_order(std::uint64_t index, double simulation_time) const;
    /// The frame of this index, after require_order(). Waits while the program takes no more; throws what it has said
    /// once it has ended.
    void write(std::span<const FramePiece> pieces, std::uint64_t index);
    /// As meniscus_session_next().
    meniscus_result next(double timeout_seconds, meniscus_frame** frame);
    PushProcess& process() { return process_; }
    const PushProcess& process() const { return process_; }

private:
    PushProcess process_;
    std::string id_;
    std::optional<std::uint64_t> last_index_;
};

/// Throws NotBuilt.
[[noreturn]] void not_through_push(const std::string& what, const std::string& remedy);

}  // namespace meniscus::c
