// A mesh to the messages that carry it.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

#include "meniscus/mesh.hpp"
#include "meniscus/statistics.hpp"
#include "sessions/encoded_frame.hpp"
#include "sessions/worker_pool.hpp"

namespace meniscus::server {

/// A frame after its reconstruction.
struct ReconstructedFrame {
    std::uint64_t index = 0;
    double simulation_time = 0.0;
    std::chrono::steady_clock::time_point received_at;
    Mesh mesh;
    Statistics statistics;
};

/// Called with every message as soon as it is there, one call at a time. The parts of a brick follow one another.
using MessageSink = std::function<void(const SharedMessage&)>;

/// Encodes the bricks in parallel; sink may be empty.
std::shared_ptr<const EncodedFrame> encode_frame(const ReconstructedFrame& frame, int normal_bits, WorkerPool& workers,
                                                 const MessageSink& sink);

/// The statistics alone, for a simulator that wants no meshes.
SharedMessage encode_statistics(const ReconstructedFrame& frame);

}  // namespace meniscus::server
