#include "formats/brick_file.hpp"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/delimited_message_util.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "formats/atomic_file.hpp"
#include "formats/byte_cursor.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::formats {
namespace {

constexpr std::size_t part_bytes = std::size_t{1} << 20;
constexpr std::uint32_t smallest_offset_bits = 2;
constexpr std::uint32_t largest_offset_bits = 9;

std::string to_string(const std::vector<std::byte>& bytes, std::size_t first, std::size_t size) {
    std::string out(size, '\0');
    if (size > 0) std::memcpy(out.data(), bytes.data() + first, size);
    return out;
}

void append(std::vector<std::byte>& out, const std::string& bytes) {
    const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
    out.insert(out.end(), first, first + bytes.size());
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
    out.set_draco(to_string(brick.draco, first, std::min(part_bytes, brick.draco.size() - first)));
    out.set_part_index(static_cast<std::uint32_t>(part));
    out.set_part_count(static_cast<std::uint32_t>(parts));
    return message;
}

v1::StreamResponse statistics_message(const client::ReceivedFrame& frame) {
    const client::FrameStatistics& s = frame.statistics;
    v1::StreamResponse message;
    v1::FrameStatistics& out = *message.mutable_frame_statistics();
    out.set_frame_index(frame.index);
    out.set_simulation_time(frame.simulation_time);
    out.set_particles(s.particles);
    out.set_vertices(s.vertices);
    out.set_triangles(s.triangles);
    out.mutable_triangles_by_level()->set_level1(s.triangles_by_level[0]);
    out.mutable_triangles_by_level()->set_level2(s.triangles_by_level[1]);
    out.mutable_triangles_by_level()->set_level3(s.triangles_by_level[2]);
    out.mutable_triangles_by_level()->set_crack(s.triangles_by_level[3]);
    out.mutable_base_cells_by_level()->set_level1(s.base_cells_by_level[0]);
    out.mutable_base_cells_by_level()->set_level2(s.base_cells_by_level[1]);
    out.mutable_base_cells_by_level()->set_level3(s.base_cells_by_level[2]);
    out.set_field_evaluations(s.field_evaluations);
    v1::StageSeconds& stages = *out.mutable_stage_seconds();
    const auto& seconds = s.stage_seconds;
    stages.set_register_particles(seconds[static_cast<std::size_t>(Stage::register_particles)]);
    stages.set_split_cells(seconds[static_cast<std::size_t>(Stage::split_cells)]);
    stages.set_adjust_levels(seconds[static_cast<std::size_t>(Stage::adjust_levels)]);
    stages.set_sample_field(seconds[static_cast<std::size_t>(Stage::sample_field)]);
    stages.set_count_triangles(seconds[static_cast<std::size_t>(Stage::count_triangles)]);
    stages.set_place_vertices(seconds[static_cast<std::size_t>(Stage::place_vertices)]);
    stages.set_emit_triangles(seconds[static_cast<std::size_t>(Stage::emit_triangles)]);
    stages.set_fill_cracks(seconds[static_cast<std::size_t>(Stage::fill_cracks)]);
    out.set_total_seconds(s.total_seconds);
    out.set_encode_seconds(s.encode_seconds);
    out.set_latency_seconds(s.latency_seconds);
    out.set_peak_bytes(s.peak_bytes);
    out.set_allocations(s.allocations);
    out.set_backend(s.backend);
    out.set_threads(s.threads);
    out.set_encoded_bytes(s.encoded_bytes);
    return message;
}

client::FrameStatistics read_statistics(const v1::FrameStatistics& in) {
    client::FrameStatistics s;
    s.particles = in.particles();
    s.vertices = in.vertices();
    s.triangles = in.triangles();
    s.triangles_by_level = {in.triangles_by_level().level1(), in.triangles_by_level().level2(), in.triangles_by_level().level3(),
                            in.triangles_by_level().crack()};
    s.base_cells_by_level = {in.base_cells_by_level().level1(), in.base_cells_by_level().level2(), in.base_cells_by_level().level3()};
    s.field_evaluations = in.field_evaluations();
    const v1::StageSeconds& stages = in.stage_seconds();
    s.stage_seconds = {stages.register_particles(), stages.split_cells(), stages.adjust_levels(), stages.sample_field(),
                       stages.count_triangles(), stages.place_vertices(), stages.emit_triangles(), stages.fill_cracks()};
    s.total_seconds = in.total_seconds();
    s.encode_seconds = in.encode_seconds();
    s.latency_seconds = in.latency_seconds();
    s.peak_bytes = in.peak_bytes();
    s.allocations = in.allocations();
    s.backend = in.backend();
    s.threads = in.threads();
    s.encoded_bytes = in.encoded_bytes();
    return s;
}

/// Reads message after message and knows which may follow.
class BrickFileReader {
public:
    BrickFileReader(const std::string& name, std::string_view bytes)
        : in_(name, bytes),
          stream_(bytes.data(), static_cast<int>(std::min<std::size_t>(bytes.size(), std::numeric_limits<int>::max()))) {
        if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
            in_.fail(std::to_string(bytes.size()) + " bytes; at most 2147483647 are read");
    }

    client::ReceivedFrame read() {
        const v1::StreamResponse first = next();
        if (!first.has_mesh_begin()) in_.fail("not a file of bricks: it does not begin with a mesh");
        const v1::MeshBegin& begin = first.mesh_begin();
        if (begin.brick_cells() != static_cast<std::uint32_t>(brick_cells))
            in_.fail("bricks of " + std::to_string(begin.brick_cells()) + " cells; " + std::to_string(brick_cells) + " are read");
        if (begin.offset_bits() < smallest_offset_bits || begin.offset_bits() > largest_offset_bits)
            in_.fail("offset_bits " + std::to_string(begin.offset_bits()) + " is not one of 2 to 9");
        if (!std::isfinite(begin.cell_size()) || begin.cell_size() <= 0.0)
            in_.fail("cell_size " + std::to_string(begin.cell_size()) + " is not above 0");
        frame_.index = begin.frame_index();
        frame_.simulation_time = begin.simulation_time();
        frame_.cell_size = begin.cell_size();
        frame_.offset_bits = begin.offset_bits();
        for (std::uint32_t i = 0; i < begin.brick_count(); ++i) read_brick();
        const v1::StreamResponse last = next();
        if (!last.has_frame_statistics()) in_.fail("its bricks are not followed by statistics");
        frame_.statistics = read_statistics(last.frame_statistics());
        return std::move(frame_);
    }

private:
    v1::StreamResponse next() {
        v1::StreamResponse message;
        bool ended = false;
        if (!google::protobuf::util::ParseDelimitedFromZeroCopyStream(&message, &stream_, &ended))
            in_.fail(ended ? "truncated: it ends at byte " + std::to_string(stream_.ByteCount()) + " where a message is expected"
                           : "truncated or not a file of bricks: no message at byte " + std::to_string(stream_.ByteCount()));
        return message;
    }

    void read_brick() {
        EncodedBrick brick;
        std::uint32_t parts = 1;
        for (std::uint32_t part = 0; part < parts; ++part) {
            const v1::StreamResponse message = next();
            if (!message.has_mesh_brick()) in_.fail("fewer bricks than announced");
            const v1::MeshBrick& in = message.mesh_brick();
            if (part == 0) {
                parts = in.part_count();
                brick.coordinate = {in.x(), in.y(), in.z()};
                brick.vertices = in.vertex_count();
                brick.triangles = in.triangle_count();
                append(brick.cell_levels, in.cell_levels());
            }
            if (parts == 0 || in.part_index() != part || in.part_count() != parts || in.x() != brick.coordinate[0] ||
                in.y() != brick.coordinate[1] || in.z() != brick.coordinate[2])
                in_.fail("the parts of a brick are out of order");
            append(brick.draco, in.draco());
        }
        frame_.bricks.push_back(std::move(brick));
    }

    ByteCursor in_;
    google::protobuf::io::ArrayInputStream stream_;
    client::ReceivedFrame frame_;
};

}  // namespace

void write_bricks(const std::filesystem::path& path, const client::ReceivedFrame& frame) {
    AtomicFile file(path);
    const auto write = [&](const v1::StreamResponse& message) {
        google::protobuf::util::SerializeDelimitedToOstream(message, &file.stream());
    };
    write(begin_message(frame));
    for (const EncodedBrick& brick : frame.bricks) {
        const std::size_t parts = std::max<std::size_t>(1, (brick.draco.size() + part_bytes - 1) / part_bytes);
        for (std::size_t part = 0; part < parts; ++part) write(part_message(brick, part, parts));
    }
    write(statistics_message(frame));
    file.commit();
}

client::ReceivedFrame read_bricks(const std::string& name, std::string_view bytes) { return BrickFileReader(name, bytes).read(); }

client::ReceivedFrame encode_frame(const Mesh& mesh, const Statistics& statistics, std::uint64_t index, double simulation_time,
                                   const CodingOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    client::ReceivedFrame frame;
    frame.index = index;
    frame.simulation_time = simulation_time;
    frame.cell_size = mesh.cell_size;
    frame.offset_bits = mesh.offset_bits;
    static_cast<Statistics&>(frame.statistics) = statistics;
    for (std::size_t i = 0; i < mesh.bricks.size(); ++i) {
        frame.bricks.push_back(encode_brick(mesh, i, options));
        frame.statistics.encoded_bytes += frame.bricks.back().draco.size() + frame.bricks.back().cell_levels.size();
    }
    frame.statistics.encode_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return frame;
}

}  // namespace meniscus::formats
