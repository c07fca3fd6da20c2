// The golden table: for each scene and its settings the mesh, as hashes. Those of color and density are of commit
// 609d103, those of smooth of the commit that brought the field.
//
// A mesh that differs in a single bit is a change for users. Only a commit that wants such a change replaces
// hashes: a row that fails prints its name and the line to put into golden_hashes.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "meniscus/mesh.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"

namespace meniscus::test {

/// Everything that the row's mesh depends on, so that a changed default changes no mesh.
struct GoldenRow {
    std::string name;
    std::string scene;  ///< name of one of golden_scenes()
    Field field;
    Mode mode;
    double smoothing;  ///< the smoothing length, or the smoothness of the smooth field; radii
    double cell_size;  ///< radii
    double iso;        ///< field value at the surface
    double tolerance;  ///< tolerance of the curvature criterion, finest cells; 0: the count criterion decides
    std::uint32_t count_threshold;  ///< threshold of the count criterion; 0: the curvature criterion decides
    std::uint32_t bisection_steps;  ///< 0: edge points are interpolated
    bool normals;
    bool cropped;   ///< whether a domain cuts the scene
    int max_level;  ///< 3: as reconstructed; 1, 2: emitted once more with the levels capped

    Settings settings() const;
};

std::vector<GoldenRow> golden_rows();

/// The expected hashes of golden_rows().
struct GoldenHashes {
    std::string_view row;
    std::string_view mesh_sha256;
    std::string_view bytes;  ///< golden_bytes()
};
std::vector<GoldenHashes> golden_hashes();

/// SHA-256 over the digits of bricks_sha256 of all rows, one after the other.
inline constexpr std::string_view golden_bricks = "27c3de74ef1466bdaa657b501e30919c7dd046fe0dccc2521422d77e44526c1a";

/// FNV-1a with 64 bits, as 16 hexadecimal digits, over the bytes of vertices, normals, triangles and bricks in the
/// mesh's order, and its levels' ranges: all that mesh_sha256 leaves out.
std::string golden_bytes(const Mesh& mesh);

/// Reconstructs a row's frame on some backend.
using GoldenReconstruction = std::function<Mesh(const GoldenRow&, const ParticleFrame&)>;

/// Adds a test failure for each row whose mesh is not the golden one, and for each row or hash without the other.
void expect_golden_meshes(const GoldenReconstruction& reconstruct);

}  // namespace meniscus::test
