// The announcement of a mesh.
#pragma once

#include "meniscus/mesh.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/sending/encoded_frame.hpp"

namespace meniscus::server {

/// The message that begins a mesh, without the numbers of its bricks and triangles.
inline v1::StreamResponse begin_response(const EncodedFrame& frame) {
    v1::StreamResponse response;
    v1::MeshBegin& begin = *response.mutable_mesh_begin();
    begin.set_frame_index(frame.index);
    begin.set_run_id(frame.run_id);
    begin.set_simulation_time(frame.simulation_time);
    begin.set_cell_size(frame.cell_size);
    begin.set_offset_bits(frame.offset_bits);
    begin.set_brick_cells(static_cast<std::uint32_t>(brick_cells));
    begin.set_spray_count(frame.spray_count);
    *begin.mutable_attributes() = frame.attributes;
    return response;
}

}  // namespace meniscus::server
