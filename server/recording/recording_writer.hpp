// Writes the recordings of all sessions, on a thread of its own: no session waits for the disk, or fails with it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <variant>

#include "meniscus/settings.hpp"
#include "meniscus/v1/session_service.pb.h"
#include "process/line_limit.hpp"
#include "recording/folder_lock.hpp"
#include "recording/recorded_bytes.hpp"
#include "recording/recording_entries.hpp"
#include "recording/recording_file.hpp"
#include "recording/recording_options.hpp"
#include "recording/write_queue.hpp"
#include "sessions/sending/encoded_frame.hpp"

namespace meniscus::server {

struct RecordingCounters {
    std::uint64_t frames = 0;           ///< with their particles written
    std::uint64_t bytes = 0;            ///< written
    std::uint64_t frames_left_out = 0;  ///< particles or meshes: the disk was too slow
    std::uint64_t stopped = 0;          ///< recordings that a failure or the limit has ended
};

struct RecordedSession {
    std::string id;
    Settings settings;
    std::string owner;
    v1::SessionDescription description;
    std::atomic<bool> stopped{false};  ///< by the writer: nothing more of this session will be written
};

/// Frames of rising index: one file, created with the first of them.
struct RecordedRun {
    std::shared_ptr<RecordedSession> session;
    std::int64_t started_at = 0;  ///< microseconds since 1970-01-01 UTC
    // The following belong to the writing thread.
    std::optional<RecordingFile> file = {};
    std::uint64_t meshes = 0;
    std::uint64_t bytes = 0;
};

class RecordingWriter {
public:
    /// Creates the directory if it is missing. Throws InvalidInput if it cannot be written to, FolderInUse if
    /// another server records there.
    explicit RecordingWriter(const RecordingOptions& options);
    /// Writes what waits, until the time of finish_by(). What is left out then is counted, and the log says so.
    ~RecordingWriter();
    RecordingWriter(const RecordingWriter&) = delete;
    RecordingWriter& operator=(const RecordingWriter&) = delete;

    /// Whether there is room for this many bytes of that session; write() or cancel() follows. If not, the frame is
    /// counted as left out. The sessions of one owner share their room; one without owner has its own.
    bool reserve(const RecordedSession& session, std::size_t bytes);
    void cancel(const RecordedSession& session, std::size_t bytes);
    /// started_at: microseconds since 1970-01-01 UTC. The writing thread closes its file once nobody holds it any more.
    std::shared_ptr<RecordedRun> begin_run(std::shared_ptr<RecordedSession> session, std::int64_t started_at);
    /// Particles, or a mesh.
    using Frame = std::variant<RecordingBytes, std::shared_ptr<const EncodedFrame>>;
    void write(std::shared_ptr<RecordedRun> run, std::uint64_t frame_index, Frame frame, std::size_t reserved);

    /// The end's latest time; without it the end takes as long as the disk.
    void finish_by(std::chrono::steady_clock::time_point time) { finish_by_ = time; }

    Codec codec() const noexcept { return options_.codec; }
    int attribute_bits() const noexcept { return options_.attribute_bits; }
    std::size_t waiting_limit() const noexcept { return queue_.limit(); }
    RecordingCounters counters() const noexcept;
    /// Wall clock, microseconds since 1970-01-01 UTC, which a correction of the system's clock does not set back.
    std::int64_t wall_clock(std::chrono::steady_clock::time_point time) const;

private:
    struct Job {
        std::shared_ptr<RecordedRun> run = nullptr;
        std::uint64_t frame_index = 0;
        Frame frame = {};
        std::unique_ptr<RecordedRun> ended = nullptr;  ///< in place of them: nobody writes to it any more
    };

    void write_jobs();
    void perform(Job& job);
    void leave_out_what_waits();
    /// Throws LimitExceeded.
    void admit(std::uint64_t bytes);
    void append(RecordedRun& run, const RecordingBytes& bytes);
    void count(RecordedRun& run, std::uint64_t written);
    /// Hands it to the writing thread.
    void end(std::unique_ptr<RecordedRun> run) noexcept;
    /// Closes its file, and deletes that if it has too few frames.
    void close(const RecordedRun& run) const noexcept;

    const RecordingOptions options_;
    const std::chrono::system_clock::time_point wall_start_ = std::chrono::system_clock::now();
    const std::chrono::steady_clock::time_point steady_start_ = std::chrono::steady_clock::now();

    std::atomic<std::uint64_t> frames_{0};
    std::atomic<std::uint64_t> bytes_{0};
    std::atomic<std::uint64_t> left_out_{0};
    std::atomic<std::uint64_t> stopped_{0};

    std::optional<FolderLock> lock_;
    std::chrono::steady_clock::time_point finish_by_ = std::chrono::steady_clock::time_point::max();
    LineLimit lines_{200};    ///< about files that are begun
    RecordedBytes recorded_;  ///< of the writing thread
    WriteQueue<Job> queue_;
    std::thread thread_;
};

}  // namespace meniscus::server
