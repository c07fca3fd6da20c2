// The bytes of a publication's segment, as its writers make them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "files/publication_format.hpp"
#include "meniscus/v1/publication.pb.h"

namespace meniscus::files {

/// Collects the messages of frames, each of which is a meniscus.v1.WatchResponse as it travels: the first frame whole,
/// the others whole or as differences to the frame before.
class SegmentFile {
public:
    /// Most bytes of the messages. The index and the lengths are far smaller than the room that this leaves.
    static constexpr std::size_t most_bytes = max_segment_bytes - (std::size_t{1} << 28);

    /// Whether this message still fits, beside the index.
    bool has_room_for(std::size_t message_bytes) const noexcept;
    /// The messages that follow are this frame's. index: greater than that of the frame before.
    void begin_frame(std::uint64_t index, double simulation_time);
    void add(std::string_view message);
    /// The newest frame goes, of which messages may be missing.
    void take_back();

    bool empty() const noexcept { return begin_.frames_size() == 0; }
    /// Bytes of the messages.
    std::size_t bytes() const noexcept { return messages_.size(); }
    /// Index of the newest frame; there is one.
    std::uint64_t last_index() const { return begin_.frames(begin_.frames_size() - 1).index(); }

    struct Built {
        v1::PublishedSegment entry;  ///< in the manifest, but its run_id and its seconds
        std::string bytes;
    };
    /// The file, of at least one frame. Empties this object.
    Built build();

private:
    v1::SegmentBegin begin_;
    std::string messages_;
};

/// The text of manifest.json. wire: but its format and version.
std::string manifest_json(v1::Publication wire);

}  // namespace meniscus::files
