// Meshes on a GPU as Python sees them.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>

#include "meniscus/device_mesh.hpp"
#include "surfaces/shared_reconstructor.hpp"

namespace meniscus::python {

/// The class _meniscus.DeviceMesh.
struct DeviceMeshHandle {
    DeviceMesh mesh;
    std::shared_ptr<SharedReconstructor> owner;  ///< of the memory
    std::uint64_t call = 0;                      ///< of the owner's, which made it
};

/// __cuda_array_interface__, version 3, of "lattice", "triangles", "normals" or "attribute NAME". Throws InvalidInput
/// for what the mesh does not have.
pybind11::dict interface_of(const DeviceMesh& mesh, const std::string& name);

}  // namespace meniscus::python
