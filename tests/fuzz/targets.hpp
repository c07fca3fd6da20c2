// Readers of untrusted bytes. Each target takes any bytes: it may refuse them, and must not crash, hang
// or ask for memory that the bytes do not justify. libFuzzer makes the bytes (tests/fuzz/run); the test suite tries the
// seeds and damage to them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace meniscus::fuzz {

using Bytes = std::string_view;
using Seeds = std::vector<std::string>;

/// Messages of a Stream call, as the server reads them: a list of messages.
void stream_requests(Bytes bytes);
Seeds stream_request_seeds();

/// The piece size in which a message lies in memory (1 byte), and a message of a Stream call: what the reader of
/// particle bytes takes for a chunk, protobuf takes for the same.
void frame_chunks(Bytes bytes);
Seeds frame_chunk_seeds();

/// Parts of one frame: whether all attributes are kept (1 byte), their number less 1 (1 byte), a list of their
/// FrameBegin, and which part sends its next bytes (1 byte) and how many (2 bytes), again and again.
void frame_parts(Bytes bytes);
Seeds frame_parts_seeds();
/// Choices and parts less 1 (1 byte each), a PublishBegin for each part (length: 2 bytes), then what the parts send.
void finished_bricks(Bytes bytes);
Seeds finished_bricks_seeds();

/// The request of a Watch call.
void watch_requests(Bytes bytes);
Seeds watch_request_seeds();

/// Answers of a Stream and of a Watch call, as the client reads them, and their meshes: a list of messages.
void stream_responses(Bytes bytes);
Seeds stream_response_seeds();
void watch_responses(Bytes bytes);
Seeds watch_response_seeds();

/// Answers of a WatchParticles call: a list of messages.
void particle_responses(Bytes bytes);
Seeds particle_response_seeds();

/// The wire's Settings.
void settings(Bytes bytes);
Seeds settings_seeds();

/// One brick: offset bits (1 byte), vertices, triangles, bytes of cell levels (uint32 each), cell levels, Draco bytes.
void brick(Bytes bytes);
Seeds brick_seeds();

/// The same with the bytes of a lattice codec, of each profile.
void lattice_packed(Bytes bytes);
Seeds lattice_packed_seeds();
void lattice_entropy(Bytes bytes);
Seeds lattice_entropy_seeds();

/// Attributes as they were announced: their number (1 byte); type, components and bits of each (1 byte each). Then one
/// brick, as above.
void brick_with_attributes(Bytes bytes);
Seeds brick_with_attributes_seeds();

/// Bytes of a client to the HTTP port, on one connection.
void http(Bytes bytes);
Seeds http_seeds();

/// A header's value (length: 1 byte) and a body of a gRPC-Web request.
void grpc_web(Bytes bytes);
Seeds grpc_web_seeds();

// Files.
void vtk(Bytes bytes);
Seeds vtk_seeds();
void particle_ply(Bytes bytes);
Seeds particle_ply_seeds();
void xyz(Bytes bytes);
Seeds xyz_seeds();
void mesh_ply(Bytes bytes);
Seeds mesh_ply_seeds();
void mesh_obj(Bytes bytes);
Seeds mesh_obj_seeds();
void vtk_xml(Bytes bytes);
Seeds vtk_xml_seeds();
void npy(Bytes bytes);
Seeds npy_seeds();
void npz(Bytes bytes);
Seeds npz_seeds();
void bgeo(Bytes bytes);
Seeds bgeo_seeds();
void particle_json(Bytes bytes);
Seeds particle_json_seeds();
void bi4(Bytes bytes);
Seeds bi4_seeds();
/// The pickle inside PySPH's .npz.
void pickle(Bytes bytes);
Seeds pickle_seeds();
void mesh_vtk(Bytes bytes);
Seeds mesh_vtk_seeds();
void mesh_vtp(Bytes bytes);
Seeds mesh_vtp_seeds();
void mesh_npz(Bytes bytes);
Seeds mesh_npz_seeds();
void brick_file(Bytes bytes);
Seeds brick_file_seeds();
void recording(Bytes bytes);
Seeds recording_seeds();
/// A recording as `meniscus push` reads it, front to back.
void piped_recording(Bytes bytes);
/// Files of bricks, likewise.
void piped_bricks(Bytes bytes);
Seeds piped_bricks_seeds();

/// A publication's manifest.
void publication_manifest(Bytes bytes);
Seeds publication_manifest_seeds();
/// Frames, index of the first and of the last (1 byte each), and a segment of which the manifest says these.
void publication_segment(Bytes bytes);
Seeds publication_segment_seeds();

struct Target {
    const char* name;
    void (*run)(Bytes);
    Seeds (*seeds)();
};

/// All of the above.
const std::vector<Target>& targets();

}  // namespace meniscus::fuzz
