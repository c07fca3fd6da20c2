// The recordings of a server.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "meniscus/client/next.hpp"
#include "meniscus/client/normals_by.hpp"
#include "meniscus/client/received_frame.hpp"
#include "meniscus/client/session_info.hpp"

namespace meniscus::client {

/// Frames of a session that the server has kept: one file of its folder of recordings.
struct RecordingInfo {
    std::string session_id;
    std::uint32_t number = 0;  ///< of the session's recordings, from 1
    std::string owner;         ///< the maker of the session; empty where names were not asked for
    SessionDescription description;
    std::chrono::system_clock::time_point started_at;
    std::uint64_t frames = 0;  ///< those with a mesh, here and below
    std::optional<std::uint64_t> first_frame_index;
    std::optional<std::uint64_t> last_frame_index;
    std::uint64_t bytes = 0;
    bool being_written = false;
    bool damaged = false;  ///< behind the last of these frames
};

/// Which of a recording's frames to read, by their places in it.
struct ReadOptions {
    std::uint64_t position = 0;  ///< of the first, less than RecordingInfo::frames
    std::uint64_t count = 0;     ///< at most; 0: all from there on
    bool spray = false;          ///< whether the particles left out of the surface come beside the meshes
    std::stop_token stop{};      ///< when a stop is requested: as cancel()
    /// server: as recorded. receiver saves no bytes here: recordings are sent as they are.
    NormalsBy normals_by = NormalsBy::server;
};

/// Reads frames that were recorded, in order. All but cancel() belongs to one thread.
class RecordingReader {
public:
    RecordingReader(RecordingReader&&) noexcept;
    RecordingReader& operator=(RecordingReader&&) noexcept;
    ~RecordingReader();

    /// Waits for the next frame; none after the last. Throws InvalidInput for a position past the end, LimitExceeded
    /// when too many read, or ServerError.
    std::optional<ReceivedFrame> next();
    /// These three functions work as those of Watcher.
    Next<ReceivedFrame> next(std::chrono::milliseconds timeout);
    Next<ReceivedFrame> try_next() { return next(std::chrono::milliseconds(0)); }
    void cancel();

private:
    friend class Client;
    class Impl;
    explicit RecordingReader(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus::client
