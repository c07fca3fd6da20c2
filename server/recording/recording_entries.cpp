#include "recording/recording_entries.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include "conversion/particle_arrays.hpp"
#include "conversion/settings_conversion.hpp"
#include "files/recording_checksums.hpp"
#include "files/recording_format.hpp"
#include "meniscus/v1/recording.pb.h"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/limits/limits.hpp"

namespace meniscus::server {

namespace {

/// So that no name makes the entry one that readers refuse.
constexpr std::size_t max_owner_bytes = files::max_recording_entry_bytes / 2;

void append_varint(std::string& out, std::uint64_t value) {
    for (; value >= 0x80; value >>= 7U) out += static_cast<char>((value & 0x7fU) | 0x80U);
    out += static_cast<char>(value);
}

void append_delimited(std::string& out, const google::protobuf::MessageLite& message) {
    append_varint(out, message.ByteSizeLong());
    message.AppendToString(&out);
}

void append_entry(std::string& out, const v1::RecordingEntry& entry) {
    const std::string bytes = files::seal(entry);
    append_varint(out, bytes.size());
    out += bytes;
}

/// The entry of these messages, which are complete.
std::string entry_of(const std::string& messages, v1::RecordingEntry entry) {
    entry.set_bytes(messages.size());
    entry.set_messages_checksum(files::checksum(messages));
    std::string out;
    append_entry(out, entry);
    return out;
}

/// A field that holds `size` bytes, up to them.
std::string field_before(int number, std::size_t size) {
    constexpr std::uint64_t length_delimited = 2;
    std::string out;
    append_varint(out, static_cast<std::uint64_t>(number) << 3U | length_delimited);
    append_varint(out, size);
    return out;
}

/// A StreamRequest with this chunk, written by hand: its bytes are copied once.
void append_chunk(std::string& out, std::string_view data) {
    const std::string inner = field_before(v1::FrameChunk::kDataFieldNumber, data.size());
    const std::string outer = field_before(v1::StreamRequest::kFrameChunkFieldNumber, inner.size() + data.size());
    append_varint(out, outer.size() + inner.size() + data.size());
    out.append(outer).append(inner).append(data);
}

void append_chunks(std::string& out, std::span<const std::byte> bytes) {
    for (; !bytes.empty(); bytes = bytes.subspan(std::min(bytes.size(), chunk_bytes)))
        append_chunk(out, {reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), chunk_bytes)});
}

v1::StreamRequest begin_message(const InputFrame& frame) {
    v1::StreamRequest request;
    v1::FrameBegin& begin = *request.mutable_frame_begin();
    begin.set_frame_index(frame.index);
    begin.set_simulation_time(frame.simulation_time);
    begin.set_particle_count(frame.particle_count);
    *begin.mutable_arrays() = conversion::particle_arrays(frame.quantized, frame.has_levels, frame.view().arrays);
    if (frame.quantized) *begin.mutable_quantization_box() = conversion::to_wire(frame.quantization_box);
    return request;
}

}  // namespace

std::string recording_begin(const std::string& session_id, const Settings& settings, std::int64_t started_at,
                            const std::string& owner, const v1::SessionDescription& description) {
    v1::RecordingEntry entry;
    v1::RecordingBegin& begin = *entry.mutable_begin();
    begin.set_version(files::recording_version);
    begin.set_session_id(session_id);
    *begin.mutable_settings() = conversion::to_wire(settings);
    begin.set_started_at(started_at);
    if (owner.size() <= max_owner_bytes) begin.set_owner(owner);
    if (description.ByteSizeLong() != 0) *begin.mutable_description() = description;
    std::string out(files::recording_magic);
    append_entry(out, entry);
    return out;
}

RecordingBytes recorded_particles(const InputFrame& frame, std::int64_t arrived_at) {
    RecordingBytes bytes;
    const v1::StreamRequest begin = begin_message(frame);
    const std::span<const ParticleArray> arrays = frame.view().arrays;
    // Not to grow while the particles are copied: 12 bytes at most before each chunk, and the messages around them.
    constexpr std::size_t before_a_chunk = 16;
    constexpr std::size_t around = 64;
    const bool is_finished = !frame.brick_parts.empty();
    const std::size_t size = is_finished ? 0 : frame.bytes.size();
    bytes.messages.reserve(size + (size / chunk_bytes + arrays.size() + 1) * before_a_chunk + begin.ByteSizeLong() +
                           around);
    append_delimited(bytes.messages, begin);
    append_chunks(bytes.messages, std::span(frame.bytes).first(frame.particle_bytes()));
    for (const ParticleArray& array : arrays) append_chunks(bytes.messages, array.data);
    v1::StreamRequest end;
    end.mutable_frame_end();
    append_delimited(bytes.messages, end);

    v1::RecordingEntry entry;
    v1::RecordedParticles& particles = *entry.mutable_particles();
    particles.set_frame_index(frame.index);
    particles.set_simulation_time(frame.simulation_time);
    particles.set_particle_count(frame.particle_count);
    particles.set_arrived_at(arrived_at);
    particles.set_finished_bricks(is_finished);
    bytes.entry = entry_of(bytes.messages, std::move(entry));
    return bytes;
}

RecordingBytes recorded_mesh(const EncodedFrame& frame) {
    RecordingBytes bytes;
    frame.for_each_message([&](const SharedMessage& message) {
        append_varint(bytes.messages, message->size());
        bytes.messages.append(*message);
    });
    v1::RecordingEntry entry;
    entry.mutable_mesh()->set_frame_index(frame.index);
    bytes.entry = entry_of(bytes.messages, std::move(entry));
    return bytes;
}

}  // namespace meniscus::server
