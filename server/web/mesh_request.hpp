// The requests of GET /sessions/ID/latest.glb.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "meniscus/v1/mesh.pb.h"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::server {

inline constexpr std::string_view snapshot_method = "/meniscus.v1.SurfaceService/Snapshot";

struct MeshRequest {
    std::string session;  ///< as it came
    bool draco = false;   ///< the bricks' bytes as they are, in place of one mesh that every reader of glTF takes
    std::vector<std::string> attributes;  ///< that a plain mesh has; "all": every one of the session's
};

/// Whether the target of a request, as in its first line, is a session's mesh, whatever stands for the session.
bool is_mesh_target(std::string_view target);

/// target: of a mesh. Throws InvalidInput for parameters that are not known, or do not go together.
MeshRequest mesh_request(std::string_view target);

v1::SnapshotRequest snapshot_request(const MeshRequest& asked);

/// Equal only for equal files. instance: of the session, which the snapshot's metadata has. Empty for a run without a
/// name: nothing sets its frames apart from those of another.
std::string entity_tag(const MeshRequest& asked, std::string_view instance, const v1::MeshBegin& mesh);

}  // namespace meniscus::server
