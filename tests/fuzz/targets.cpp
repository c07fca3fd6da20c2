#include "targets.hpp"

namespace meniscus::fuzz {

const std::vector<Target>& targets() {
    static const std::vector<Target> all{
        {"stream_requests", stream_requests, stream_request_seeds},
        {"frame_chunks", frame_chunks, frame_chunk_seeds},
        {"frame_parts", frame_parts, frame_parts_seeds},
        {"finished_bricks", finished_bricks, finished_bricks_seeds},
        {"watch_requests", watch_requests, watch_request_seeds},
        {"stream_responses", stream_responses, stream_response_seeds},
        {"watch_responses", watch_responses, watch_response_seeds},
        {"particle_responses", particle_responses, particle_response_seeds},
        {"settings", settings, settings_seeds},
        {"brick", brick, brick_seeds},
        {"lattice_packed", lattice_packed, lattice_packed_seeds},
        {"lattice_entropy", lattice_entropy, lattice_entropy_seeds},
        {"brick_with_attributes", brick_with_attributes, brick_with_attributes_seeds},
        {"http", http, http_seeds},
        {"grpc_web", grpc_web, grpc_web_seeds},
        {"vtk", vtk, vtk_seeds},
        {"particle_ply", particle_ply, particle_ply_seeds},
        {"xyz", xyz, xyz_seeds},
        {"mesh_ply", mesh_ply, mesh_ply_seeds},
        {"mesh_obj", mesh_obj, mesh_obj_seeds},
        {"vtk_xml", vtk_xml, vtk_xml_seeds},
        {"npy", npy, npy_seeds},
        {"npz", npz, npz_seeds},
        {"bgeo", bgeo, bgeo_seeds},
        {"particle_json", particle_json, particle_json_seeds},
        {"bi4", bi4, bi4_seeds},
        {"pickle", pickle, pickle_seeds},
        {"mesh_vtk", mesh_vtk, mesh_vtk_seeds},
        {"mesh_vtp", mesh_vtp, mesh_vtp_seeds},
        {"mesh_npz", mesh_npz, mesh_npz_seeds},
        {"brick_file", brick_file, brick_file_seeds},
        {"recording", recording, recording_seeds},
        {"piped_bricks", piped_bricks, piped_bricks_seeds},
        {"piped_recording", piped_recording, recording_seeds},
        {"publication_manifest", publication_manifest, publication_manifest_seeds},
        {"publication_segment", publication_segment, publication_segment_seeds},
    };
    return all;
}

}  // namespace meniscus::fuzz
