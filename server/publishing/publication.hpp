// One session's meshes as the files of a publication, in memory. proto/README.md has the format.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "files/segment_file.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/v1/publication.pb.h"
#include "meniscus/v1/session_service.pb.h"
#include "publishing/publishing_options.hpp"
#include "sessions/sending/encoded_frame.hpp"
#include "sessions/watching/mesh_update.hpp"

namespace meniscus::server {

/// Of all publications of a server.
struct PublishingCounters {
    std::atomic<std::uint64_t> frames{0};    ///< in segments
    std::atomic<std::uint64_t> bytes{0};     ///< of segments that were made
    std::atomic<std::uint64_t> left_out{0};  ///< frames for which there was no room, or not for long enough
    std::atomic<std::uint64_t> sent{0};      ///< bytes of files that were asked for
    std::atomic<std::uint64_t> held{0};  ///< bytes of segments now, those included that have left and are being sent
};

/// A file of a publication; it never changes.
struct PublishedFile {
    PublishedFile(std::string content, std::string sha256_of_it, std::shared_ptr<PublishingCounters> counted)
        : bytes(std::move(content)), sha256(std::move(sha256_of_it)), counters(std::move(counted)) {
        counters->held += bytes.size();
    }
    ~PublishedFile() { counters->held -= bytes.size(); }
    PublishedFile(const PublishedFile&) = delete;
    PublishedFile& operator=(const PublishedFile&) = delete;

    const std::string bytes;
    const std::string sha256;
    const std::shared_ptr<PublishingCounters> counters;
};

/// Thread-safe. A session writes to it, one at a time: each has the turn that begin() gave it, and what an earlier one
/// still does has no effect.
class Publication {
public:
    using Clock = std::chrono::steady_clock;

    Publication(std::string owner, const Settings& settings, const PublishingOptions& options,
                std::shared_ptr<PublishingCounters> counters);

    const std::string& owner() const noexcept { return owner_; }
    const Settings& settings() const noexcept { return settings_; }

    // The session's side.

    /// A session of this owner and these settings publishes here from now on. Returns its turn.
    std::uint64_t begin(const v1::SessionDescription& description);
    /// A frame of rising index within its run; one that was published before its session began is passed over. Throws
    /// LimitExceeded, before anything of it is copied, for one that has no room by itself.
    void add(std::uint64_t turn, const EncodedFrame& frame, Clock::time_point now);
    /// No other frame comes.
    void end(std::uint64_t turn, Clock::time_point now);

    // The server's side.

    /// Ends the open segment if its time is over, and forgets segments whose readers have had their time.
    void tidy(Clock::time_point now);
    /// For how long its session has ended; none: it lives.
    std::optional<Clock::duration> ended_for(Clock::time_point now) const;
    /// Of its segments.
    std::size_t bytes() const;
    /// Its oldest segment goes at once.
    void drop_oldest();

    // The readers' side.

    /// The file of this name; null: there is none.
    std::shared_ptr<const PublishedFile> find(std::string_view name) const;

private:
    struct Segment {
        v1::PublishedSegment entry;
        std::shared_ptr<const PublishedFile> file;
        std::optional<Clock::time_point> left_at{};  ///< the manifest

        bool is_listed() const noexcept { return !left_at; }
    };

    // With writing_ held.

    void append(const EncodedFrame& frame, Clock::time_point now);
    std::size_t most_frame_bytes() const { return std::min(limit_, files::SegmentFile::most_bytes); }
    void end_segment(Clock::time_point now);

    std::shared_ptr<const PublishedFile> manifest_file() const;

    // With mutex_ held.

    /// The manifest with its segments.
    v1::Publication whole_manifest() const;
    /// Its file is to be made anew.
    void change_manifest() noexcept;
    /// The manifest.
    void leave(Segment& segment, Clock::time_point now);
    /// There is one.
    void remove_oldest();
    void take_attributes(const EncodedFrame& frame);
    bool has(std::uint64_t run_id, std::uint64_t index) const;

    const std::string owner_;
    const Settings settings_;
    const std::optional<double> keep_seconds_;  ///< of the newest frames; none: all
    const std::size_t limit_;                   ///< of its segments' bytes
    const std::shared_ptr<PublishingCounters> counters_;

    std::mutex writing_;  ///< for what follows
    std::uint64_t turn_ = 0;
    bool goes_on_ = false;  ///< a frame of this turn has come that was not there
    files::SegmentFile open_;
    WatcherMesh base_;  ///< the newest frame of the open segment
    std::uint64_t open_run_ = 0;
    double open_seconds_ = 0.0;
    Clock::time_point opened_at_{};
    std::optional<Clock::time_point> last_at_;  ///< the frame before

    mutable std::mutex mutex_;      ///< for what follows; taken after writing_
    v1::Publication manifest_;      ///< but its segments
    std::deque<Segment> segments_;  ///< those first that have left the manifest
    std::size_t bytes_ = 0;         ///< of them
    std::optional<Clock::time_point> ended_at_;
    std::uint64_t changes_ = 0;                                   ///< of the manifest
    mutable std::shared_ptr<const PublishedFile> manifest_file_;  ///< null: it is to be made anew
};

}  // namespace meniscus::server
