// A segment of a publication: frames to bytes and back.
#pragma once

#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include <cstddef>
#include <optional>
#include <string>

#include "meniscus/client/publication.hpp"
#include "meniscus/v1/publication.pb.h"
#include "receiving/frame_receiver.hpp"

namespace meniscus::client {

/// Collects frames, the first whole and the others as differences, as far as these save bricks.
class SegmentBuilder {
public:
    /// Throws LimitExceeded if the segment would have more bytes than any.
    void add(const ReceivedFrame& frame, double seconds);

    bool empty() const noexcept { return begin_.frames_size() == 0; }
    std::size_t bytes() const noexcept { return messages_.size(); }
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
    v1::SegmentBegin begin_;
    std::string messages_;
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
