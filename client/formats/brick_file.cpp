#include "formats/brick_file.hpp"

#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/delimited_message_util.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>
#include <utility>

#include "conversion/codec_conversion.hpp"
#include "conversion/statistics_conversion.hpp"
#include "formats/atomic_file.hpp"
#include "formats/byte_cursor.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "receiving/frame_receiver.hpp"

namespace meniscus::formats {
namespace {

constexpr std::size_t part_bytes = std::size_t{1} << 20;
std::string to_string(const std::vector<std::byte>& bytes, std::size_t first, std::size_t size) {
    std::string out(size, '\0');
    if (size > 0) std::memcpy(out.data(), bytes.data() + first, size);
    return out;
}

v1::StreamResponse begin_message(const client::ReceivedFrame& frame) {
    v1::StreamResponse message;
    v1::MeshBegin& begin = *message.mutable_mesh_begin();
    begin.set_frame_index(frame.index);
    begin.set_simulation_time(frame.simulation_time);
    begin.set_cell_size(frame.cell_size);
    begin.set_offset_bits(frame.offset_bits);
    begin.set_brick_cells(brick_cells);
    begin.set_brick_count(static_cast<std::uint32_t>(frame.bricks.size()));
    begin.set_run_id(frame.run_id);
    std::uint64_t triangles = 0;
    for (const auto& brick : frame.bricks) triangles += brick->triangles;
    begin.set_triangle_count(triangles);
    return message;
}

v1::StreamResponse part_message(const EncodedBrick& brick, std::size_t part, std::size_t parts) {
    v1::StreamResponse message;
    v1::MeshBrick& out = *message.mutable_mesh_brick();
    out.set_x(brick.coordinate[0]);
    out.set_y(brick.coordinate[1]);
    out.set_z(brick.coordinate[2]);
    out.set_vertex_count(brick.vertices);
    out.set_triangle_count(brick.triangles);
    if (part == 0) out.set_cell_levels(to_string(brick.cell_levels, 0, brick.cell_levels.size()));
    const std::size_t first = part * part_bytes;
    out.set_codec(conversion::to_wire(brick.codec));
    out.set_data(to_string(brick.data, first, std::min(part_bytes, brick.data.size() - first)));
    out.set_part_index(static_cast<std::uint32_t>(part));
    out.set_part_count(static_cast<std::uint32_t>(parts));
    return message;
}

v1::StreamResponse statistics_message(const client::ReceivedFrame& frame) {
    v1::StreamResponse message;
    v1::FrameStatistics& out = *message.mutable_frame_statistics();
    conversion::to_wire(frame.statistics, out);
    out.set_frame_index(frame.index);
    out.set_simulation_time(frame.simulation_time);
    out.set_encode_seconds(frame.statistics.encode_seconds);
    out.set_latency_seconds(frame.statistics.latency_seconds);
    out.set_encoded_bytes(frame.statistics.encoded_bytes);
    return message;
}

}  // namespace

void write_bricks(const std::filesystem::path& path, const client::ReceivedFrame& frame) {
    AtomicFile file(path);
    const auto write = [&](const v1::StreamResponse& message) {
        google::protobuf::util::SerializeDelimitedToOstream(message, &file.stream());
    };
    write(begin_message(frame));
    for (const auto& brick : frame.bricks) {
        const std::size_t parts = std::max<std::size_t>(1, (brick->data.size() + part_bytes - 1) / part_bytes);
        for (std::size_t part = 0; part < parts; ++part) write(part_message(*brick, part, parts));
    }
    write(statistics_message(frame));
    file.commit();
}

client::ReceivedFrame read_bricks(const std::string& name, std::string_view bytes) {
    const ByteCursor in(name, bytes);
    constexpr std::size_t limit = std::numeric_limits<int>::max();  // of protobuf's streams
    if (bytes.size() > limit)
        in.fail(std::to_string(bytes.size()) + " bytes; at most " + std::to_string(limit) + " are read");
    google::protobuf::io::ArrayInputStream stream(bytes.data(), static_cast<int>(bytes.size()));
    // Statistics are of the whole surface; a watcher may have asked for less, so they need not be of this mesh.
    client::FrameReceiver receiver(true, true);
    while (true) {
        const std::string place = std::to_string(stream.ByteCount());
        v1::StreamResponse message;
        bool ended = false;
        if (!google::protobuf::util::ParseDelimitedFromZeroCopyStream(&message, &stream, &ended))
            in.fail(ended ? "truncated: it ends at byte " + place + ", within a frame"
                          : "truncated or not a file of bricks: no message at byte " + place);
        try {
            if (auto frame = receiver.take(message)) return std::move(*frame);
        } catch (const client::ServerError& e) {
            in.fail("at byte " + place + ": " + e.what());
        }
    }
}

client::ReceivedFrame encode_frame(const Mesh& mesh, const Statistics& statistics, std::uint64_t index,
                                   double simulation_time, const CodingOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    client::ReceivedFrame frame;
    frame.index = index;
    frame.simulation_time = simulation_time;
    frame.cell_size = mesh.cell_size;
    frame.offset_bits = mesh.offset_bits;
    static_cast<Statistics&>(frame.statistics) = statistics;
    for (std::size_t i = 0; i < mesh.bricks.size(); ++i) {
        const auto brick = std::make_shared<const EncodedBrick>(encode_brick(mesh, i, options));
        frame.statistics.encoded_bytes += brick->data.size() + brick->cell_levels.size();
        frame.bricks.push_back(brick);
    }
    frame.statistics.encode_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return frame;
}

}  // namespace meniscus::formats
