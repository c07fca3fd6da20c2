#include "formats/recordings/brick_file.hpp"

#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/delimited_message_util.h>

#include <limits>
#include <utility>

#include "files/brick_file_format.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/bytes/byte_cursor.hpp"
#include "meniscus/v1/brick_file.pb.h"
#include "meniscus/v1/surface_service.pb.h"
#include "receiving/frame_messages.hpp"
#include "receiving/frame_receiver.hpp"

namespace meniscus::formats {
namespace {

/// Messages, each after its length.
class Messages {
public:
    /// Borrows both.
    Messages(const ByteCursor& in, std::string_view bytes)
        : in_(in), stream_(bytes.data(), static_cast<int>(bytes.size())) {
        constexpr std::size_t limit = std::numeric_limits<int>::max();  // of protobuf's streams
        if (bytes.size() > limit)
            in.fail(std::to_string(bytes.size()) + " bytes; at most " + std::to_string(limit) + " are read");
    }

    void skip(std::size_t bytes) { stream_.Skip(static_cast<int>(bytes)); }
    /// Returns the byte at which the message begins, as text.
    std::string next(google::protobuf::MessageLite& message) {
        std::string place = std::to_string(stream_.ByteCount());
        bool ended = false;
        if (!google::protobuf::util::ParseDelimitedFromZeroCopyStream(&message, &stream_, &ended))
            in_.fail(ended ? "truncated: it ends at byte " + place + ", within a frame"
                           : "truncated or not a file of bricks: no message at byte " + place);
        return place;
    }

private:
    const ByteCursor& in_;
    google::protobuf::io::ArrayInputStream stream_;
};

client::ReceivedFrame read_frame(const ByteCursor& in, Messages& messages) {
    // Statistics are of the whole surface; a watcher may have asked for less, so they need not be of this mesh.
    client::FrameReceiver receiver(true, true);
    while (true) {
        v1::StreamResponse message;
        const std::string place = messages.next(message);
        try {
            if (auto frame = receiver.take(message)) return std::move(*frame);
        } catch (const client::ServerError& e) {
            in.fail("at byte " + place + ": " + e.what());
        }
    }
}

[[noreturn]] void refuse_version(const ByteCursor& in, std::uint32_t version) {
    in.fail("a file of bricks of format version " + std::to_string(version) + "; this program reads version " +
            std::to_string(files::brick_file_version) + ": read it with the Meniscus that wrote it");
}

/// Refuses a file without the magic. Version 1 had none: it began with the message that begins a mesh.
[[noreturn]] void refuse_beginning(const ByteCursor& in, std::string_view bytes) {
    if (files::brick_file_magic.starts_with(bytes)) in.fail("truncated: it ends within its first bytes");
    google::protobuf::io::ArrayInputStream stream(bytes.data(), static_cast<int>(bytes.size()));
    v1::StreamResponse message;
    bool ended = false;
    if (google::protobuf::util::ParseDelimitedFromZeroCopyStream(&message, &stream, &ended) && message.has_mesh_begin())
        refuse_version(in, 1);
    in.fail("not a file of bricks");
}

}  // namespace

void write_bricks(const std::filesystem::path& path, const client::ReceivedFrame& frame) {
    AtomicFile file(path);
    const auto write = [&](const google::protobuf::MessageLite& message) {
        std::string bytes;
        {
            google::protobuf::io::StringOutputStream stream(&bytes);
            google::protobuf::util::SerializeDelimitedToZeroCopyStream(message, &stream);
        }
        file.write(bytes);
    };
    file.write(files::brick_file_magic);
    v1::BrickFileBegin begin;
    begin.set_version(files::brick_file_version);
    write(begin);
    client::give_messages(frame, nullptr, write);
    file.commit();
}

client::ReceivedFrame read_bricks(const std::string& name, std::string_view bytes) {
    const ByteCursor in(name, bytes);
    Messages messages(in, bytes);
    if (!bytes.starts_with(files::brick_file_magic)) refuse_beginning(in, bytes);
    messages.skip(files::brick_file_magic.size());
    v1::BrickFileBegin begin;
    messages.next(begin);
    if (begin.version() != files::brick_file_version) refuse_version(in, begin.version());
    return read_frame(in, messages);
}

client::ReceivedFrame read_brick_messages(const std::string& name, std::string_view bytes) {
    const ByteCursor in(name, bytes);
    Messages messages(in, bytes);
    return read_frame(in, messages);
}

}  // namespace meniscus::formats
