// Puts received messages together, and believes none of them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>

#include "meniscus/client/client.hpp"
#include "meniscus/v1/mesh.pb.h"

namespace meniscus::client {

/// Throws ServerError for messages that are out of order, missing, repeated, or contradict each other.
class FrameReceiver {
public:
    /// meshes: whether they come, or statistics alone.
    explicit FrameReceiver(bool meshes) : meshes_(meshes) {}

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
            case Response::kFrameStatistics:
                return end(response.frame_statistics());
            default:
                throw ServerError("the server sent a message of a kind that this version does not know");
        }
    }

    /// The server has nothing more to send.
    void end_of_stream() const;

private:
    void begin(const v1::MeshBegin& message);
    void add(const v1::MeshBrick& message);
    ReceivedFrame end(const v1::FrameStatistics& message);

    const bool meshes_;
    std::optional<ReceivedFrame> frame_;          ///< between its begin and its statistics
    std::uint32_t brick_count_ = 0;               ///< as announced
    std::uint32_t missing_parts_ = 0;             ///< of the brick received last
    std::uint32_t part_count_ = 0;                ///< of the same
    std::uint64_t triangles_ = 0;
    std::set<std::array<std::int32_t, 3>> places_;
};

}  // namespace meniscus::client
