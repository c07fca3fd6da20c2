// A mesh that stays on the GPU, for a renderer in the same process.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "meniscus/element_type.hpp"
#include "meniscus/mesh.hpp"

namespace meniscus {

/// An attribute of the vertices, as MeshAttribute.
struct DeviceMeshAttribute {
    std::string name;
    ElementType type = ElementType::float32;
    std::size_t components = 1;  ///< numbers per vertex
    const void* data = nullptr;  ///< device pointer, to the numbers of each vertex, one vertex after the other
};

/// The members are those of Mesh, in device memory that the reconstructor owns. The mesh is complete on every stream
/// when the caller gets it, and valid until the reconstructor's next call or end. A caller that still reads it on
/// another stream by then must make `stream` wait for that stream (cudaStreamWaitEvent).
struct DeviceMesh {
    const LatticePosition* vertices = nullptr;  ///< device pointer
    const Normal* normals = nullptr;            ///< device pointer, one per vertex; null if Settings::normals is false
    const Triangle* triangles = nullptr;        ///< device pointer
    std::vector<DeviceMeshAttribute> attributes;  ///< as the settings name them, in that order
    std::uint32_t vertex_count = 0;
    std::uint32_t triangle_count = 0;
    std::array<TriangleRange, triangle_level_count> levels{};  ///< ranges of `triangles`
    double cell_size = 0.0;  ///< a vertex lies at position * cell_size / 2^offset_bits
    std::uint32_t offset_bits = 0;
    int device = 0;          ///< index of the GPU
    void* stream = nullptr;  ///< the reconstructor's cudaStream_t
};

}  // namespace meniscus
