#include "pushing/frame_bytes.hpp"

#include <algorithm>

#include "files/recording_format.hpp"
#include "pushing/wire_message.hpp"

namespace meniscus::pushing {
namespace {

// Numbers of fields and of enumerators: proto/meniscus/v1/recording.proto, surface_service.proto.
constexpr unsigned entry_begin = 1, entry_particles = 2, entry_bytes = 4;
constexpr unsigned begin_version = 1;
constexpr unsigned particles_index = 1, particles_time = 2, particles_count = 3;
constexpr unsigned request_begin = 2, request_chunk = 3, request_end = 4;
constexpr unsigned frame_index = 1, frame_time = 2, frame_count = 3, frame_arrays = 7;
constexpr unsigned array_name = 1, array_type = 2, array_components = 3;
constexpr unsigned chunk_data = 1;

constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

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

}  // namespace meniscus::pushing
