#include <cmath>

#include "conversion/attribute_conversion.hpp"
#include "conversion/particle_arrays.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "receiving/frame_receiver.hpp"
#include "receiving/particle_receiver.hpp"
#include "support.hpp"

namespace meniscus::fuzz {

namespace {

template <class Response>
void receive(Bytes bytes, bool differences) {
    client::FrameReceiver receiver(true, differences);
    Front front(bytes);
    may_refuse([&] {
        while (!front.empty()) {
            const Bytes message = front.piece(front.number(2));
            Response response;
            if (!response.ParseFromArray(message.data(), static_cast<int>(message.size()))) return;
            const auto frame = receiver.take(response);
            if (!frame) continue;
            for (const Point& point : frame->spray)
                for (const float x : point) require(std::isfinite(x), "spray is finite");
            may_refuse([&] { (void)frame->mesh(); });
        }
        receiver.end_of_stream();
    });
}

/// One frame with all of its bricks, the first in two parts, and its spray in two messages.
template <class Response>
std::vector<Response> whole_frame() {
    const Mesh mesh = sample_mesh(true);
    const std::vector<AttributeRange> ranges = attribute_ranges(mesh);
    const std::vector<AttributeWish> wishes{{"velocity", 8}, {"id", 8}};
    CodingOptions options;
    options.attributes = coded_attributes(mesh, ranges, wishes);
    std::vector<Response> responses;
    v1::MeshBegin& begin = *responses.emplace_back().mutable_mesh_begin();
    begin.set_frame_index(3);
    begin.set_cell_size(mesh.cell_size);
    begin.set_offset_bits(mesh.offset_bits);
    begin.set_brick_cells(brick_cells);
    begin.set_brick_count(static_cast<std::uint32_t>(mesh.bricks.size()));
    begin.set_triangle_count(mesh.triangles.size());
    begin.set_spray_count(2);
    conversion::to_wire(mesh, ranges, options.attributes, begin);
    for (std::size_t i = 0; i < mesh.bricks.size(); ++i) {
        const EncodedBrick encoded = encode_brick(mesh, i, options);
        const std::string data(reinterpret_cast<const char*>(encoded.data.data()), encoded.data.size());
        const std::size_t parts = i == 0 ? 2 : 1;
        for (std::size_t part = 0; part < parts; ++part) {
            v1::MeshBrick& brick = *responses.emplace_back().mutable_mesh_brick();
            brick.set_x(encoded.coordinate[0]);
            brick.set_y(encoded.coordinate[1]);
            brick.set_z(encoded.coordinate[2]);
            brick.set_vertex_count(encoded.vertices);
            brick.set_triangle_count(encoded.triangles);
            if (part == 0) brick.set_cell_levels(encoded.cell_levels.data(), encoded.cell_levels.size());
            const std::size_t cut = part * data.size() / parts;
            brick.set_codec(v1::CODEC_DRACO);
            brick.set_data(data.substr(cut, (part + 1) * data.size() / parts - cut));
            brick.set_part_index(static_cast<std::uint32_t>(part));
            brick.set_part_count(static_cast<std::uint32_t>(parts));
        }
    }
    for (const char* point : {"\0\0\0\0\0\0\0\0\0\0\0\0", "1234567890ab"})
        responses.emplace_back().mutable_spray_points()->set_positions(point, 12);
    v1::FrameStatistics& statistics = *responses.emplace_back().mutable_frame_statistics();
    statistics.set_frame_index(3);
    statistics.set_triangles(mesh.triangles.size());
    return responses;
}

/// The frame after it, in which the first brick has vanished.
std::vector<v1::WatchResponse> difference() {
    const Mesh mesh = sample_mesh();
    std::vector<v1::WatchResponse> responses = whole_frame<v1::WatchResponse>();
    v1::MeshBegin begin = responses.front().mesh_begin();
    begin.set_frame_index(4);
    begin.set_base_frame_index(3);
    begin.set_brick_count(0);
    begin.set_triangle_count(mesh.triangles.size() - mesh.bricks[0].triangle_count());
    v1::BrickPlace& place = *begin.add_vanished();
    place.set_x(mesh.bricks[0].coordinate[0]);
    place.set_y(mesh.bricks[0].coordinate[1]);
    place.set_z(mesh.bricks[0].coordinate[2]);
    *responses.emplace_back().mutable_mesh_begin() = begin;
    responses.emplace_back().mutable_frame_statistics()->set_frame_index(4);
    return responses;
}

/// A frame of two particles with levels, in two chunks.
std::vector<v1::WatchParticlesResponse> particles() {
    std::vector<v1::WatchParticlesResponse> responses(1);
    v1::ParticlesBegin& begin = *responses.front().mutable_particles_begin();
    begin.set_particle_count(4);
    begin.set_stride(2);
    begin.set_sent_count(2);
    *begin.mutable_arrays() = conversion::particle_arrays(true, true);
    begin.set_particle_radius(0.1);
    begin.mutable_quantization_box()->mutable_min()->set_x(-1.0);
    begin.mutable_quantization_box()->mutable_max()->set_x(1.0);
    for (const char* data : {"123456789012", "\x01\x02"})
        responses.emplace_back().mutable_frame_chunk()->set_data(data);
    responses.emplace_back().mutable_frame_end();
    return responses;
}

}  // namespace

void particle_responses(Bytes bytes) {
    client::ParticleReceiver receiver;
    Front front(bytes);
    may_refuse([&] {
        while (!front.empty()) {
            const Bytes message = front.piece(front.number(2));
            v1::WatchParticlesResponse response;
            if (!response.ParseFromArray(message.data(), static_cast<int>(message.size()))) return;
            const auto frame = receiver.take(response);
            if (!frame) continue;
            require(frame->levels.empty() || 3 * frame->levels.size() == frame->quantized.size(),
                    "each particle has a level, or none");
        }
        receiver.end_of_stream();
    });
}

Seeds particle_response_seeds() {
    return {join(particles())};
}

void stream_responses(Bytes bytes) {
    receive<v1::StreamResponse>(bytes, false);
}

Seeds stream_response_seeds() {
    return {join(whole_frame<v1::StreamResponse>())};
}

void watch_responses(Bytes bytes) {
    receive<v1::WatchResponse>(bytes, true);
}

Seeds watch_response_seeds() {
    return {join(whole_frame<v1::WatchResponse>()), join(difference())};
}

}  // namespace meniscus::fuzz
