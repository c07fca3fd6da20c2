// Meshes as Python sees them.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <variant>

#include "meniscus/client/received_frame.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus::python {

/// The class _meniscus.Mesh. The arrays that view its memory keep it alive. Python may destroy it in any thread: what
/// has threads has OwnProcessDelete (process.hpp).
struct MeshHandle {
    std::shared_ptr<const Mesh> mesh;
    /// Whether an empty mesh has normals, which its arrays cannot show.
    bool has_normals = true;
    /// Where the mesh is from: reconstructed here, or received, as it travelled. For a file of bricks.
    std::variant<Statistics, std::shared_ptr<const client::ReceivedFrame>> origin;
};

/// The figures of the frame that the mesh is of.
inline const Statistics& statistics_of(const MeshHandle& handle) {
    if (const auto* received = std::get_if<std::shared_ptr<const client::ReceivedFrame>>(&handle.origin))
        return (*received)->statistics;
    return std::get<Statistics>(handle.origin);
}

/// mesh: an object of that class.
inline const Mesh& mesh_of(const pybind11::object& mesh) {
    return *pybind11::cast<const MeshHandle&>(mesh).mesh;
}

}  // namespace meniscus::python
