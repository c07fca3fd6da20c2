// A surface as plain files: a manifest and segments, which a folder or any web host holds. proto/README.md has the
// format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "meniscus/client/received_frame.hpp"
#include "meniscus/client/session_info.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::client {

/// A file of frames that follow one another.
struct PublishedSegment {
    std::string sha256;  ///< of its bytes; it names the file
    std::uint64_t bytes = 0;
    std::uint64_t frames = 0;       ///< at least 1
    double seconds = 0.0;           ///< how long its frames are shown at the pace of publishing
    std::uint64_t first_frame = 0;  ///< index, here and below; they rise within a segment
    std::uint64_t last_frame = 0;
    double first_time = 0.0;  ///< simulation time, seconds, here and below
    double last_time = 0.0;
    std::uint64_t run_id = 0;  ///< the run of its frames; 0: none

    bool operator==(const PublishedSegment&) const = default;
    /// The name of its file.
    std::string file() const;
};

/// The content of a manifest.
struct PublicationInfo {
    SessionDescription description;
    /// None where this version does not understand them: meshes do not need them to be read.
    std::optional<Settings> settings;
    std::vector<FrameAttribute> attributes;  ///< that vertices carry; ranges are over all frames that were published
    NormalsBy normals_by = NormalsBy::server;
    bool live = false;              ///< whether more frames may come
    std::uint64_t left_frames = 0;  ///< before the first segment; their files are gone
    std::uint64_t frames = 0;       ///< of all segments
    std::uint64_t bytes = 0;        ///< of all segments
    std::vector<PublishedSegment> segments;
};

/// Gives the bytes of a file of a publication, by its name. Throws InvalidInput for a file of more than `most_bytes`,
/// and for one that is not there.
using FetchFile = std::function<std::string(const std::string& name, std::uint64_t most_bytes)>;

/// Reads a publication, and believes nothing: each segment is held against its length and its hash in the manifest.
/// All functions throw InvalidInput in one line that names the publication or the file.
class Publication {
public:
    /// A folder, or its manifest.
    explicit Publication(const std::filesystem::path& folder);
    /// From anywhere. name: of the publication, for messages.
    Publication(std::string name, FetchFile fetch);
    Publication(Publication&&) noexcept;
    Publication& operator=(Publication&&) noexcept;
    ~Publication();

    const std::string& name() const noexcept;
    const PublicationInfo& info() const noexcept;
    /// Reads the manifest again, for the frames that have come.
    void refresh();

    /// The frame at a place, from info().left_frames on. Frames that follow one another are read once; any other place
    /// takes the frames before it in its segment. Throws, too, for a place that is not there.
    ReceivedFrame frame(std::uint64_t place);

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

/// Whether there is a publication in this folder, or this is its manifest.
bool is_publication(const std::filesystem::path& path);

}  // namespace meniscus::client
