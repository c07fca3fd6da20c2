// Publishes frames: a folder of segments, and the manifest that lists them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "meniscus/client/publication.hpp"
#include "meniscus/client/received_frame.hpp"
#include "meniscus/client/session_info.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::client {

struct PublishOptions {
    SessionDescription description{};
    NormalsBy normals_by = NormalsBy::server;  ///< receiver: readers compute the normals, which frames do not carry
    bool live = false;                         ///< whether the manifest says that more frames may come
    double segment_seconds = 1.0;              ///< a segment ends after these, or
    std::uint64_t segment_bytes = std::uint64_t{1} << 20;  ///< after these, whichever comes first
    std::optional<double> keep_seconds{};                  ///< of the newest frames; none: all stay
};

/// Adds to a folder's publication, or begins one there. A reader never sees a half: a segment is made first, and then
/// named in the manifest. One writer has a folder at a time.
class PublicationWriter {
public:
    /// Goes on with the publication that is there. settings: of the surface; none: they are not known. Throws
    /// InvalidInput if those that are there are other ones, if another process publishes there, or if the folder cannot
    /// be made.
    PublicationWriter(std::filesystem::path folder, const std::optional<Settings>& settings,
                      const PublishOptions& options);
    /// Leaves the frames that no segment has yet out.
    ~PublicationWriter();
    PublicationWriter(const PublicationWriter&) = delete;
    PublicationWriter& operator=(const PublicationWriter&) = delete;

    /// As the manifest has it: frames of an open segment are not in it.
    const PublicationInfo& info() const noexcept;
    /// Whether that frame, or a later one of its run, has been published before.
    bool has(std::uint64_t run_id, std::uint64_t index) const noexcept;

    /// Adds a frame that is shown for `seconds`. Throws std::runtime_error, naming the file, if writing fails;
    /// LimitExceeded for a frame that is larger than any segment, and where all frames stay and the manifest lists no
    /// more segments (170,000).
    void add(const ReceivedFrame& frame, double seconds);
    /// Whether frames wait for their segment to end.
    bool is_open() const noexcept;
    /// Ends the open segment, if there is one, and names it in the manifest. Throws as add() does.
    void flush();
    /// Likewise, and no more frames will come.
    void finish();

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus::client
