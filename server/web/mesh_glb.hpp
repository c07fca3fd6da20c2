// The messages of a snapshot as a file of glTF (GLB).
#pragma once

#include <grpcpp/support/byte_buffer.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "meniscus/v1/mesh.pb.h"
#include "meniscus/v1/session_service.pb.h"
#include "web/mesh_request.hpp"

namespace meniscus::server {

/// About what making the file of this mesh takes, and no less than the file.
std::uint64_t bytes_for_glb(const MeshRequest& asked, const v1::MeshBegin& mesh);

/// Throws LimitExceeded, in words for the client, for a mesh that no such file holds.
void require_possible_glb(const MeshRequest& asked, const v1::MeshBegin& mesh);

struct MeshGlb {
    v1::MeshBegin mesh;
    std::string file;
};

/// messages: of the call, up to its end. up: is turned to glTF's y. canceled: ends the work, with what it has. Throws
/// InvalidInput or std::runtime_error for messages that are no mesh, LimitExceeded for a file of 4 GiB or more.
MeshGlb mesh_glb(const MeshRequest& asked, const std::vector<grpc::ByteBuffer>& messages, v1::UpAxis up,
                 const std::atomic<bool>& canceled);

}  // namespace meniscus::server
