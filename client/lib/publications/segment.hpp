// A segment of a publication: frames to bytes and back.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "files/segment_file.hpp"
#include "meniscus/client/publication.hpp"
#include "meniscus/v1/publication.pb.h"
#include "receiving/frame_receiver.hpp"

namespace meniscus::client {

/// Collects frames, the first whole and the others as differences, as far as these save bricks.
class SegmentBuilder {
public:
    /// False: beside the others it has no room, and is not added. Throws LimitExceeded if it has none by itself.
    bool add(const ReceivedFrame& frame, double seconds);

    bool empty() const noexcept { return file_.empty(); }
    std::size_t bytes() const noexcept { return file_.bytes(); }
    double seconds() const noexcept { return seconds_; }
    /// Whether the frame can follow: it is of the same run and has a greater index.
    bool can_follow(const ReceivedFrame& frame) const noexcept;

    struct Built {
        PublishedSegment segment;
        std::string bytes;
    };
    /// The file, and empties this object.
    Built build();

private:
    files::SegmentFile file_;
    double seconds_ = 0.0;
    std::optional<ReceivedFrame> last_;
};

/// Gives the frames of a segment, one after the other.
class SegmentReader {
public:
    /// Throws InvalidInput, "NAME: ...", unless the bytes are those that the manifest has announced, and their index
    /// agrees with it.
    SegmentReader(std::string name, const PublishedSegment& segment, std::string bytes);
    SegmentReader(const SegmentReader&) = delete;
    SegmentReader& operator=(const SegmentReader&) = delete;

    /// Frames that next() has given.
    std::size_t given() const noexcept { return given_; }
    /// Throws likewise, for messages that are not the frame that the index says, and after the last frame.
    ReceivedFrame next();

private:
    [[noreturn]] void fail(const std::string& what) const;
    void read_index(const PublishedSegment& segment);

    std::string name_;
    std::string bytes_;
    v1::SegmentBegin begin_;
    std::size_t messages_at_ = 0;  ///< of the file
    std::size_t given_ = 0;
    FrameReceiver receiver_{true, true};
};

}  // namespace meniscus::client
