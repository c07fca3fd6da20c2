// The arrays of a mesh, which view its memory. mesh: an object of the class _meniscus.Mesh.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace meniscus::python {

pybind11::array lattice_view(const pybind11::object& mesh);
pybind11::array triangles_view(const pybind11::object& mesh);
/// None where it has none.
pybind11::object normals_view(const pybind11::object& mesh);
pybind11::array spray_view(const pybind11::object& mesh);
/// (name, array) of each.
pybind11::list attribute_views(const pybind11::object& mesh);

}  // namespace meniscus::python
