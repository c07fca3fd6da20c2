#include "sessions/sending/frame_encoder.hpp"

#include <algorithm>
#include <mutex>
#include <span>
#include <utility>

#include "conversion/attribute_conversion.hpp"
#include "meniscus/attribute_coding.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/packed_bricks.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/sending/begin_message.hpp"
#include "sessions/sending/brick_messages.hpp"
#include "sessions/sending/spray_messages.hpp"
#include "sessions/sending/statistics_message.hpp"

namespace meniscus::server {

namespace {

using Clock = std::chrono::steady_clock;

// One serialization serves both RPCs, as the contract says of WatchResponse.
static_assert(int{v1::StreamResponse::kMeshBeginFieldNumber} == int{v1::WatchResponse::kMeshBeginFieldNumber});
static_assert(int{v1::StreamResponse::kMeshBrickFieldNumber} == int{v1::WatchResponse::kMeshBrickFieldNumber});
static_assert(int{v1::StreamResponse::kSprayPointsFieldNumber} == int{v1::WatchResponse::kSprayPointsFieldNumber});
static_assert(int{v1::StreamResponse::kFrameStatisticsFieldNumber} ==
              int{v1::WatchResponse::kFrameStatisticsFieldNumber});

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

SharedMessage serialize(const v1::StreamResponse& response) {
    return std::make_shared<const std::string>(response.SerializeAsString());
}

/// Bricks that the earlier frame has need not come down.
void leave_known_bricks(PackedBricks& packed, const Mesh& mesh, const std::vector<SharedBrick>& before) {
    for (std::size_t i = 0; i < mesh.bricks.size(); ++i) {
        const SharedBrick brick = find_brick(before, mesh.bricks[i].coordinate);
        if (brick && brick->content_hash == packed.hash(i)) packed.leave(i);
    }
}

google::protobuf::RepeatedPtrField<v1::MeshAttribute> announced(const Mesh& mesh,
                                                                std::span<const AttributeRange> ranges,
                                                                std::span<const CodedAttribute> coded) {
    v1::MeshBegin begin;
    conversion::to_wire(mesh, ranges, coded, begin);
    return std::move(*begin.mutable_attributes());
}

FrameStatistics statistics_of(const ReconstructedFrame& frame, const MeshDownload& download) {
    FrameStatistics statistics{frame.statistics};
    statistics.frame_index = frame.index;
    statistics.simulation_time = frame.simulation_time;
    if (!frame.finished) statistics.download_seconds = download.seconds();
    statistics.latency_seconds = seconds_since(frame.received_at);
    return statistics;
}

}  // namespace

std::shared_ptr<const EncodedFrame> encode_frame(const ReconstructedFrame& frame, const MeshFormat& format,
                                                 const EncodedFrame* before, WorkerPool& workers, ScratchPool& scratch,
                                                 const MessageSink& sink, bool spray_to_sink) {
    const MeshDownload& download = frame.download_at(format.max_level);
    // Spray lies beside the mesh as reconstructed, whatever its level cap.
    const Array<Point>& spray = frame.mesh.spray;
    const Mesh& mesh = *frame.mesh_at(format.max_level);
    // The ranges are those of the whole mesh, and announced before its first brick.
    const std::vector<AttributeRange>& ranges = frame.ranges_at(format.max_level);
    const CodingOptions coding{.normal_bits = format.normal_bits,
                               .position_bits = format.position_bits,
                               .codec = format.codec,
                               .attributes = coded_attributes(mesh, ranges, format.attributes)};
    const std::shared_ptr<PackedBricks> packed = download.pack(mesh, coding);
    if (!packed) download.start();
    const auto start = Clock::now();
    auto encoded = std::make_shared<EncodedFrame>();
    encoded->index = frame.index;
    encoded->run_id = frame.run_id;
    encoded->simulation_time = frame.simulation_time;
    encoded->received_at = frame.received_at;
    encoded->cell_size = mesh.cell_size;
    encoded->offset_bits = encoded_offset_bits(mesh, coding);
    encoded->spray_count = spray.size();
    encoded->spray = spray_messages(spray);
    encoded->attributes = announced(mesh, ranges, coding.attributes);
    const auto emit = [&](const SharedMessage& message) {
        if (sink) sink(message);
    };
    v1::StreamResponse begin = begin_response(*encoded);
    const std::size_t bricks = frame.finished ? frame.finished->bricks.size() : mesh.bricks.size();
    begin.mutable_mesh_begin()->set_brick_count(static_cast<std::uint32_t>(bricks));
    begin.mutable_mesh_begin()->set_triangle_count(frame.finished ? frame.finished->triangles : mesh.triangles.size());
    encoded->begin = serialize(begin);
    emit(encoded->begin);

    std::mutex emitting;
    std::uint64_t bytes = 0;
    static const std::vector<SharedBrick> none;
    const std::vector<SharedBrick>& earlier = before != nullptr ? before->bricks : none;
    encoded->bricks.resize(bricks);
    if (packed) leave_known_bricks(*packed, mesh, earlier);
    const auto encoded_brick = [&](std::size_t i) {
        if (!packed) download.bring(i);
        SharedBrick brick = find_brick(earlier, mesh.bricks[i].coordinate);
        ScratchPool::Loan loan(scratch);
        const PreparedBrick prepared =
            packed ? PreparedBrick(*packed, i, coding, *loan) : PreparedBrick(mesh, i, coding, *loan);
        const ContentHash hash = prepared.hash();
        if (!brick || brick->content_hash != hash) brick = brick_messages(prepared.encode(), hash);
        return brick;
    };
    std::optional<RecodedBricks> recoded;
    if (frame.finished) recoded.emplace(*frame.finished, coding);
    const auto recoded_brick = [&](std::size_t i) {
        ScratchPool::Loan loan(scratch);
        return recoded->brick(i, earlier, *loan);
    };
    workers.for_each(bricks, [&](std::size_t i) {
        const SharedBrick brick = recoded ? recoded_brick(i) : encoded_brick(i);
        encoded->bricks[i] = brick;
        const std::lock_guard lock(emitting);
        bytes += brick->bytes;
        for (const SharedMessage& message : brick->messages) emit(message);
    });

    if (spray_to_sink)
        for (const SharedMessage& message : encoded->spray) emit(message);
    encoded->statistics = statistics_of(frame, download);
    encoded->statistics.encode_seconds = seconds_since(start);
    encoded->statistics.encoded_bytes = bytes;
    encoded->end = serialize(encoded->statistics);
    return encoded;
}

FrameStatistics statistics_of(const ReconstructedFrame& frame) {
    return statistics_of(frame, frame.download);
}

SharedMessage serialize(const FrameStatistics& statistics) {
    v1::StreamResponse response;
    *response.mutable_frame_statistics() = statistics_message(statistics);
    return serialize(response);
}

}  // namespace meniscus::server
