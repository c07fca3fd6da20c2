// An upload in a build without the service: `meniscus push` speaks to the server.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "pushing/frame_bytes.hpp"
#include "pushing/push_options.hpp"
#include "pushing/push_process.hpp"

namespace meniscus::pushing {

class PushedUpload {
public:
    /// Starts the program, writes the beginning of what it is to read, and waits for its session. Throws
    /// client::ServerError, or what the program says.
    PushedUpload(const std::string& program, const PushArguments& arguments, const std::string& beginning);

    const std::string& session_id() const { return id_; }
    /// Throws InvalidInput unless the index is above the one before, and the time finite.
    void require_order(std::uint64_t index, double simulation_time) const;
    /// The frame of this index, after require_order(). Waits while the program takes no more; throws what it has said
    /// once it has ended.
    void write(std::span<const FramePiece> pieces, std::uint64_t index);
    PushProcess& process() { return process_; }
    const PushProcess& process() const { return process_; }

private:
    PushProcess process_;
    std::string id_;
    std::optional<std::uint64_t> last_index_;
};

}  // namespace meniscus::pushing
