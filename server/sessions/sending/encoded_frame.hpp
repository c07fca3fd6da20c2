// A frame as it goes out: immutable messages, shared by all receivers.
#pragma once

#include <array>
#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/codec.hpp"
#include "meniscus/v1/mesh.pb.h"
#include "sessions/sending/frame_statistics.hpp"

namespace meniscus::server {

/// One StreamResponse, which is a WatchResponse byte for byte, in protobuf's wire format.
using SharedMessage = std::shared_ptr<const std::string>;

/// How a mesh is encoded. Receivers with equal formats share one encode.
struct MeshFormat {
    int max_level = 3;      ///< finest level of grid, 1 to 3
    int position_bits = 0;  ///< vertices lie on multiples of c / 2^position_bits; 0: as reconstructed
    int normal_bits = 0;    ///< per octahedral component; 0: no normals
    Codec codec = Codec::draco;
    std::vector<AttributeWish> attributes{};  ///< of canonical_attributes()
    auto operator<=>(const MeshFormat&) const =
        default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 means what the compiler writes here
};

/// One brick, or its parts in order. The same in every frame in which the brick is the same.
struct BrickMessages {
    std::array<std::int32_t, 3> place{};  ///< x y z in bricks
    ContentHash content_hash{};           ///< of what was encoded
    std::uint32_t triangles = 0;
    std::size_t bytes = 0;
    std::vector<SharedMessage> messages;
};

using SharedBrick = std::shared_ptr<const BrickMessages>;

/// A whole mesh with its statistics, in one format.
struct EncodedFrame {
    std::uint64_t index = 0;
    std::uint64_t run_id = 0;
    double simulation_time = 0.0;
    std::chrono::steady_clock::time_point received_at;  ///< the last byte of its particles
    double cell_size = 0.0;
    std::uint32_t offset_bits = 0;
    /// Announced, whether or not the bricks carry them.
    google::protobuf::RepeatedPtrField<v1::MeshAttribute> attributes;
    SharedMessage begin;               ///< announces the whole mesh
    std::vector<SharedBrick> bricks;   ///< ordered by place (z, y, x)
    std::uint64_t spray_count = 0;     ///< points in all of the next
    std::vector<SharedMessage> spray;  ///< for receivers that ask for it
    FrameStatistics statistics;
    SharedMessage end;  ///< carries the statistics

    /// The messages that carry the whole mesh and its spray, in their order.
    template <class Visit>
    void for_each_message(const Visit& visit) const {
        visit(begin);
        for (const SharedBrick& brick : bricks)
            for (const SharedMessage& message : brick->messages) visit(message);
        for (const SharedMessage& message : spray) visit(message);
        visit(end);
    }
};

}  // namespace meniscus::server
