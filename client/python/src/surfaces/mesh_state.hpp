// Meshes as values that can be pickled.
#pragma once

#include <pybind11/pybind11.h>

#include "surfaces/mesh.hpp"

namespace meniscus::python {

/// Everything that the mesh consists of by name: its arrays, viewed, and the figures of its frame.
pybind11::dict state_of(const pybind11::object& mesh);
/// The same mesh with memory of its own. Throws InvalidInput for what no mesh can consist of.
MeshHandle mesh_of_state(const pybind11::dict& state);

}  // namespace meniscus::python
