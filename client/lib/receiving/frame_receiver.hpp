// Puts received messages together, and believes none of them.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "meniscus/client/client.hpp"
#include "meniscus/v1/mesh.pb.h"

namespace meniscus::client {

/// Throws ServerError for messages that are out of order, missing, repeated, or contradict each other.
class FrameReceiver {
public:
    /// meshes: whether they come, or statistics alone. differences: whether meshes may come as differences to the one
    /// before, and be given up for a newer one, as a watcher's may.
    explicit FrameReceiver(bool meshes, bool differences = false) : meshes_(meshes), differences_(differences) {}

    /// A StreamResponse or a WatchResponse. Returns the frame that it completes.
    template <class Response>
    std::optional<ReceivedFrame> take(const Response& response) {
        switch (response.message_case()) {
            case Response::kMeshBegin:
                begin(response.mesh_begin());
                return std::nullopt;
            case Response::kMeshBrick:
                add(response.mesh_brick());
                return std::nullopt;
            case Response::kSprayPoints:
                add(response.spray_points());
                return std::nullopt;
            case Response::kFrameStatistics:
                return end(response.frame_statistics());
            case Response::kDraining:
                return std::nullopt;
            default:
                throw ServerError("the server sent a message of a kind that this version does not know");
        }
    }

    /// The server has nothing more to send.
    void end_of_stream() const;

private:
    /// z y x: the order of a mesh's bricks.
    using Place = std::array<std::int32_t, 3>;
    using Bricks = std::map<Place, std::shared_ptr<const EncodedBrick>>;

    /// The frame that begin announces and add collects, until end.
    struct Frame {
        ReceivedFrame header;
        bool has_base = false;
        std::uint64_t triangles = 0;
        std::uint32_t brick_count = 0;
        std::uint64_t spray_count = 0;
        std::set<Place> vanished;
        Bricks bricks;
        std::shared_ptr<EncodedBrick> brick;  ///< the one received last
        std::uint32_t part_count = 0;         ///< of it
        std::uint32_t missing_parts = 0;      ///< of it
    };

    void begin(const v1::MeshBegin& message);
    void begin_difference(const v1::MeshBegin& message, Frame& frame) const;
    void add(const v1::MeshBrick& message);
    void add(const v1::SprayPoints& message);
    ReceivedFrame end(const v1::FrameStatistics& message);
    void complete_mesh(const v1::FrameStatistics& message);
    void take_difference(const std::string& name, Frame& frame);

    const bool meshes_;
    const bool differences_;
    std::optional<Frame> frame_;          ///< between its begin and its statistics
    std::optional<ReceivedFrame> whole_;  ///< the last complete one, without its bricks
    Bricks bricks_;                       ///< of that
};

}  // namespace meniscus::client
