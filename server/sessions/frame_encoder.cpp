#include "sessions/frame_encoder.hpp"

#include <algorithm>
#include <mutex>
#include <utility>

#include "conversion/statistics_conversion.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/limits.hpp"

namespace meniscus::server {

namespace {

using Clock = std::chrono::steady_clock;

// One serialization serves both RPCs.
static_assert(int{v1::StreamResponse::kMeshBeginFieldNumber} == int{v1::WatchResponse::kMeshBeginFieldNumber});
static_assert(int{v1::StreamResponse::kMeshBrickFieldNumber} == int{v1::WatchResponse::kMeshBrickFieldNumber});
static_assert(int{v1::StreamResponse::kFrameStatisticsFieldNumber} ==
              int{v1::WatchResponse::kFrameStatisticsFieldNumber});

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

SharedMessage serialize(const v1::StreamResponse& response) {
    return std::make_shared<const std::string>(response.SerializeAsString());
}

SharedMessage begin_message(const ReconstructedFrame& frame) {
    v1::StreamResponse response;
    v1::MeshBegin& begin = *response.mutable_mesh_begin();
    begin.set_frame_index(frame.index);
    begin.set_simulation_time(frame.simulation_time);
    begin.set_cell_size(frame.mesh.cell_size);
    begin.set_offset_bits(frame.mesh.offset_bits);
    begin.set_brick_cells(brick_cells);
    begin.set_brick_count(static_cast<std::uint32_t>(frame.mesh.bricks.size()));
    return serialize(response);
}

std::vector<SharedMessage> brick_messages(const EncodedBrick& brick) {
    const auto* draco = reinterpret_cast<const char*>(brick.draco.data());
    const std::size_t part_count = std::max<std::size_t>(1, (brick.draco.size() + chunk_bytes - 1) / chunk_bytes);
    std::vector<SharedMessage> messages;
    messages.reserve(part_count);
    for (std::size_t part = 0; part < part_count; ++part) {
        v1::StreamResponse response;
        v1::MeshBrick& wire = *response.mutable_mesh_brick();
        wire.set_x(brick.coordinate[0]);
        wire.set_y(brick.coordinate[1]);
        wire.set_z(brick.coordinate[2]);
        wire.set_vertex_count(brick.vertices);
        wire.set_triangle_count(brick.triangles);
        if (part == 0)
            wire.set_cell_levels(reinterpret_cast<const char*>(brick.cell_levels.data()), brick.cell_levels.size());
        const std::size_t first = part * chunk_bytes;
        wire.set_draco(draco + first, std::min(chunk_bytes, brick.draco.size() - first));
        wire.set_part_index(static_cast<std::uint32_t>(part));
        wire.set_part_count(static_cast<std::uint32_t>(part_count));
        messages.push_back(serialize(response));
    }
    return messages;
}

v1::StreamResponse statistics_response(const ReconstructedFrame& frame) {
    v1::StreamResponse response;
    v1::FrameStatistics& statistics = *response.mutable_frame_statistics();
    statistics.set_frame_index(frame.index);
    statistics.set_simulation_time(frame.simulation_time);
    conversion::to_wire(frame.statistics, statistics);
    statistics.set_latency_seconds(seconds_since(frame.received_at));
    return response;
}

}  // namespace

std::shared_ptr<const EncodedFrame> encode_frame(const ReconstructedFrame& frame, int normal_bits, WorkerPool& workers,
                                                 const MessageSink& sink) {
    const auto start = Clock::now();
    auto encoded = std::make_shared<EncodedFrame>();
    encoded->frame_index = frame.index;
    const auto emit = [&](SharedMessage message) {
        if (sink) sink(message);
        encoded->messages.push_back(std::move(message));
    };
    emit(begin_message(frame));

    std::mutex emitting;
    std::uint64_t bytes = 0;
    workers.for_each(frame.mesh.bricks.size(), [&](std::size_t brick) {
        auto messages = brick_messages(encode_brick(frame.mesh, brick, {.normal_bits = normal_bits}));
        const std::lock_guard lock(emitting);
        for (SharedMessage& message : messages) {
            bytes += message->size();
            emit(std::move(message));
        }
    });

    v1::StreamResponse end = statistics_response(frame);
    end.mutable_frame_statistics()->set_encode_seconds(seconds_since(start));
    end.mutable_frame_statistics()->set_encoded_bytes(bytes);
    emit(serialize(end));
    return encoded;
}

SharedMessage encode_statistics(const ReconstructedFrame& frame) {
    return serialize(statistics_response(frame));
}

}  // namespace meniscus::server
