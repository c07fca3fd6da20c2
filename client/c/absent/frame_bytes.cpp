#include "frame_bytes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "files/recording_format.hpp"

namespace meniscus::c {
namespace {

static_assert(std::endian::native == std::endian::little, "particles travel as they lie in memory");

// Numbers of fields and of enumerators: proto/meniscus/v1/recording.proto, surface_service.proto.
constexpr unsigned entry_begin = 1, entry_particles = 2, entry_bytes = 4;
constexpr unsigned begin_version = 1;
constexpr unsigned particles_index = 1, particles_time = 2, particles_count = 3;
constexpr unsigned request_begin = 2, request_chunk = 3, request_end = 4;
constexpr unsigned frame_index = 1, frame_time = 2, frame_count = 3, frame_arrays = 7;
constexpr unsigned array_name = 1, array_type = 2, array_components = 3;
constexpr unsigned chunk_data = 1;
constexpr std::uint64_t type_float32 = 1, type_uint8 = 2, type_int32 = 4, type_uint32 = 5;

constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

std::uint64_t wire_type(ElementType type) {
    switch (type) {
        case ElementType::float32:
            return type_float32;
        case ElementType::uint8:
            return type_uint8;
        case ElementType::int32:
            return type_int32;
        case ElementType::uint32:
            return type_uint32;
    }
    return 0;
}

/// A message under construction. Fields of the value 0 are left out, as Protocol Buffers does.
class Message {
public:
    Message& number(unsigned field, std::uint64_t value) {
        if (value == 0) return *this;
        tag(field, 0);
        varint(value);
        return *this;
    }
    Message& real(unsigned field, double value) {
        std::array<char, sizeof value> bytes{};
        std::memcpy(bytes.data(), &value, sizeof value);
        if (std::all_of(bytes.begin(), bytes.end(), [](char byte) { return byte == 0; })) return *this;
        tag(field, 1);
        bytes_.append(bytes.data(), bytes.size());
        return *this;
    }
    Message& text(unsigned field, std::string_view value) {
        length(field, value.size());
        bytes_ += value;
        return *this;
    }
    Message& message(unsigned field, const Message& value) { return text(field, value.bytes_); }
    /// The tag and the length of a field whose bytes follow elsewhere.
    Message& length(unsigned field, std::size_t bytes) {
        tag(field, 2);
        varint(bytes);
        return *this;
    }

    /// After its length, of which `more` bytes follow elsewhere.
    std::string delimited(std::size_t more = 0) const {
        Message out;
        out.varint(bytes_.size() + more);
        return out.bytes_ + bytes_;
    }
    const std::string& bytes() const { return bytes_; }
    std::size_t size() const { return bytes_.size(); }

private:
    void tag(unsigned field, unsigned wire) { varint(field << 3U | wire); }
    void varint(std::uint64_t value) {
        constexpr std::uint64_t more = 0x80;
        for (; value >= more; value >>= 7U) bytes_ += static_cast<char>(value | more);
        bytes_ += static_cast<char>(value);
    }

    std::string bytes_;
};

Message described(std::string_view name, ElementType type, std::size_t components) {
    return Message().text(array_name, name).number(array_type, wire_type(type)).number(array_components, components);
}

void append_chunks(std::span<const std::byte> bytes, std::vector<FramePiece>& pieces) {
    for (; !bytes.empty(); bytes = bytes.subspan(pieces.back().data.size())) {
        const auto data = bytes.first(std::min(chunk_bytes, bytes.size()));
        const Message chunk = Message().length(chunk_data, data.size());
        const Message request = Message().length(request_chunk, chunk.size() + data.size());
        pieces.push_back({request.delimited(chunk.size() + data.size()), data});
        pieces.back().head += chunk.bytes();
    }
}

}  // namespace

std::string recording_beginning() {
    const Message begin = Message().number(begin_version, files::recording_version);
    return std::string(files::recording_magic) + Message().message(entry_begin, begin).delimited();
}

std::vector<FramePiece> frame_pieces(const ParticleFrame& frame, std::uint64_t index, double simulation_time) {
    Message begin;
    begin.number(frame_index, index).real(frame_time, simulation_time).number(frame_count, frame.count());
    begin.message(frame_arrays, described("position", ElementType::float32, 3));
    if (!frame.levels.empty()) begin.message(frame_arrays, described("level", ElementType::uint8, 1));
    for (const ParticleArray& array : frame.arrays)
        begin.message(frame_arrays, described(array.name, array.type, array.components));

    std::vector<FramePiece> pieces(1);
    pieces.push_back({Message().message(request_begin, begin).delimited(), {}});
    append_chunks(std::as_bytes(frame.positions), pieces);
    append_chunks(std::as_bytes(frame.levels), pieces);
    for (const ParticleArray& array : frame.arrays) append_chunks(array.data, pieces);
    pieces.push_back({Message().length(request_end, 0).delimited(), {}});

    std::uint64_t bytes = 0;
    for (const FramePiece& piece : pieces) bytes += piece.head.size() + piece.data.size();
    Message particles;
    particles.number(particles_index, index).real(particles_time, simulation_time);
    particles.number(particles_count, frame.count());
    pieces.front().head = Message().message(entry_particles, particles).number(entry_bytes, bytes).delimited();
    return pieces;
}

}  // namespace meniscus::c
