#include "publications/segment.hpp"

#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/delimited_message_util.h>

#include <cmath>
#include <utility>

#include "files/publication_format.hpp"
#include "meniscus/error.hpp"
#include "meniscus/sha256.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "receiving/frame_messages.hpp"

namespace meniscus::client {
namespace {

namespace pb = google::protobuf;

}  // namespace

bool SegmentBuilder::add(const ReceivedFrame& frame, double seconds) {
    file_.begin_frame(frame.index, frame.simulation_time);
    try {
        give_messages(frame, last_ ? &*last_ : nullptr, [&](const pb::MessageLite& message) {
            const std::string bytes = message.SerializeAsString();
            if (!file_.has_room_for(bytes.size()))
                throw LimitExceeded("frame " + std::to_string(frame.index) + " has more than the " +
                                    std::to_string(files::SegmentFile::most_bytes) +
                                    " bytes of a segment: take a larger cell size");
            file_.add(bytes);
        });
    } catch (const LimitExceeded&) {
        file_.take_back();
        if (file_.empty()) throw;
        return false;
    }
    seconds_ += seconds;
    last_ = frame;
    return true;
}

bool SegmentBuilder::can_follow(const ReceivedFrame& frame) const noexcept {
    return !last_ || (last_->run_id == frame.run_id && last_->index < frame.index);
}

SegmentBuilder::Built SegmentBuilder::build() {
    files::SegmentFile::Built file = file_.build();
    Built built;
    built.bytes = std::move(file.bytes);
    built.segment = {.sha256 = file.entry.sha256(),
                     .bytes = file.entry.bytes(),
                     .frames = file.entry.frames(),
                     .seconds = seconds_,
                     .first_frame = file.entry.first_frame(),
                     .last_frame = file.entry.last_frame(),
                     .first_time = file.entry.first_time(),
                     .last_time = file.entry.last_time(),
                     .run_id = last_->run_id};
    *this = {};
    return built;
}

SegmentReader::SegmentReader(std::string name, const PublishedSegment& segment, std::string bytes)
    : name_(std::move(name)), bytes_(std::move(bytes)) {
    if (bytes_.size() != segment.bytes)
        fail("it has " + std::to_string(bytes_.size()) + " bytes; the manifest says " + std::to_string(segment.bytes) +
             ": it was cut or changed");
    if (sha256_of(bytes_) != segment.sha256) fail("it does not have the SHA-256 of its name: it was changed");
    read_index(segment);
}

void SegmentReader::read_index(const PublishedSegment& segment) {
    if (!bytes_.starts_with(files::segment_magic)) fail("not a segment of a publication");
    pb::io::ArrayInputStream stream(bytes_.data(), static_cast<int>(bytes_.size()));
    stream.Skip(static_cast<int>(files::segment_magic.size()));
    bool ended = false;
    if (!pb::util::ParseDelimitedFromZeroCopyStream(&begin_, &stream, &ended)) fail("it has no index of its frames");
    if (begin_.version() != files::segment_version)
        fail("a segment of format version " + std::to_string(begin_.version()) + "; this program reads version " +
             std::to_string(files::segment_version) + ": read it with the Meniscus that wrote it");
    messages_at_ = static_cast<std::size_t>(stream.ByteCount());
    if (static_cast<std::uint64_t>(begin_.frames_size()) != segment.frames)
        fail("it has " + std::to_string(begin_.frames_size()) + " frames; the manifest says " +
             std::to_string(segment.frames));
    std::uint64_t end = 0;
    for (int i = 0; i < begin_.frames_size(); ++i) {
        const v1::SegmentFrame& frame = begin_.frames(i);
        const std::string which = "frame " + std::to_string(frame.index());
        if (i > 0 && frame.index() <= begin_.frames(i - 1).index())
            fail(which + " comes after frame " + std::to_string(begin_.frames(i - 1).index()) + "; indices rise");
        if (frame.place() != end || frame.bytes() > bytes_.size() - messages_at_ - end)
            fail(which + " has " + std::to_string(frame.bytes()) + " bytes at " + std::to_string(frame.place()) +
                 "; there it has " + std::to_string(bytes_.size() - messages_at_ - end) + " at most, at " +
                 std::to_string(end));
        end += frame.bytes();
    }
    if (end != bytes_.size() - messages_at_)
        fail("its frames have " + std::to_string(end) + " bytes of " + std::to_string(bytes_.size() - messages_at_));
    if (begin_.frames(0).index() != segment.first_frame ||
        begin_.frames(begin_.frames_size() - 1).index() != segment.last_frame)
        fail("its frames are not those from " + std::to_string(segment.first_frame) + " to " +
             std::to_string(segment.last_frame) + " that the manifest says");
}

ReceivedFrame SegmentReader::next() {
    if (given_ == static_cast<std::size_t>(begin_.frames_size())) fail("it has no further frame");
    const v1::SegmentFrame& entry = begin_.frames(static_cast<int>(given_));
    const std::string which = "frame " + std::to_string(entry.index()) + ": ";
    pb::io::ArrayInputStream stream(bytes_.data() + messages_at_ + entry.place(), static_cast<int>(entry.bytes()));
    std::optional<ReceivedFrame> frame;
    while (!frame) {
        v1::WatchResponse message;
        bool ended = false;
        if (!pb::util::ParseDelimitedFromZeroCopyStream(&message, &stream, &ended))
            fail(which + "no message at its byte " + std::to_string(stream.ByteCount()));
        try {
            frame = receiver_.take(message);
        } catch (const ServerError& error) {
            fail(which + error.what());
        }
    }
    if (stream.ByteCount() != static_cast<std::int64_t>(entry.bytes()))
        fail(which + "it ends at its byte " + std::to_string(stream.ByteCount()) + " of " +
             std::to_string(entry.bytes()));
    if (frame->index != entry.index() || frame->simulation_time != entry.simulation_time())
        fail(which + "its messages are frame " + std::to_string(frame->index) + " of time " +
             std::to_string(frame->simulation_time) + ", not of time " + std::to_string(entry.simulation_time()));
    ++given_;
    return std::move(*frame);
}

void SegmentReader::fail(const std::string& what) const {
    throw InvalidInput(name_ + ": " + what);
}

}  // namespace meniscus::client
