#include "files/segment_file.hpp"

#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/delimited_message_util.h>
#include <google/protobuf/util/json_util.h>

#include <utility>

#include "meniscus/sha256.hpp"

namespace meniscus::files {

namespace {

namespace pb = google::protobuf;

void append_length(std::size_t length, std::string& bytes) {
    constexpr std::size_t low = 0x7f;
    for (; length > low; length >>= 7) bytes += static_cast<char>((length & low) | (low + 1));
    bytes += static_cast<char>(length);
}

}  // namespace

bool SegmentFile::has_room_for(std::size_t message_bytes) const noexcept {
    return message_bytes <= most_bytes && messages_.size() <= most_bytes - message_bytes;
}

void SegmentFile::begin_frame(std::uint64_t index, double simulation_time) {
    v1::SegmentFrame& entry = *begin_.add_frames();
    entry.set_index(index);
    entry.set_simulation_time(simulation_time);
    entry.set_place(messages_.size());
}

void SegmentFile::add(std::string_view message) {
    append_length(message.size(), messages_);
    messages_ += message;
    v1::SegmentFrame& entry = *begin_.mutable_frames(begin_.frames_size() - 1);
    entry.set_bytes(messages_.size() - entry.place());
}

void SegmentFile::take_back() {
    messages_.resize(begin_.frames(begin_.frames_size() - 1).place());
    begin_.mutable_frames()->RemoveLast();
}

SegmentFile::Built SegmentFile::build() {
    begin_.set_version(segment_version);
    Built built;
    built.bytes = segment_magic;
    {
        pb::io::StringOutputStream stream(&built.bytes);
        pb::util::SerializeDelimitedToZeroCopyStream(begin_, &stream);
    }
    built.bytes += messages_;
    const v1::SegmentFrame& first = begin_.frames(0);
    const v1::SegmentFrame& last = begin_.frames(begin_.frames_size() - 1);
    built.entry.set_sha256(sha256_of(built.bytes));
    built.entry.set_bytes(static_cast<std::uint32_t>(built.bytes.size()));
    built.entry.set_frames(static_cast<std::uint32_t>(begin_.frames_size()));
    built.entry.set_first_frame(first.index());
    built.entry.set_last_frame(last.index());
    built.entry.set_first_time(first.simulation_time());
    built.entry.set_last_time(last.simulation_time());
    *this = {};
    return built;
}

std::string manifest_json(v1::Publication wire) {
    wire.set_format(std::string(publication_format));
    wire.set_version(publication_version);
    pb::util::JsonPrintOptions options;
    options.add_whitespace = true;
    options.always_print_primitive_fields = true;
    options.preserve_proto_field_names = true;
    std::string text;
    (void)pb::util::MessageToJsonString(wire, &text, options);
    return text;
}

}  // namespace meniscus::files
