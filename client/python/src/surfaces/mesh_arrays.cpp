#include "surfaces/mesh_arrays.hpp"

#include "surfaces/mesh.hpp"
#include "values/arrays_out.hpp"

namespace py = pybind11;

namespace meniscus::python {

py::array lattice_view(const py::object& self) {
    const Mesh& mesh = mesh_of(self);
    return view(py::dtype::of<std::int32_t>(), mesh.vertices.size(), 3, mesh.vertices.data(), self);
}

py::array triangles_view(const py::object& self) {
    const Mesh& mesh = mesh_of(self);
    return view(py::dtype::of<std::uint32_t>(), mesh.triangles.size(), 3, mesh.triangles.data(), self);
}

py::object normals_view(const py::object& self) {
    const auto& handle = py::cast<const MeshHandle&>(self);
    const Mesh& mesh = *handle.mesh;
    const bool has_normals = mesh.vertices.empty() ? handle.has_normals : !mesh.normals.empty();
    if (!has_normals) return py::none();
    return view(py::dtype::of<float>(), mesh.normals.size(), 3, mesh.normals.data(), self);
}

py::array spray_view(const py::object& self) {
    const Mesh& mesh = mesh_of(self);
    return view(py::dtype::of<float>(), mesh.spray.size(), 3, mesh.spray.data(), self);
}

py::list attribute_views(const py::object& self) {
    py::list out;
    const Mesh& mesh = mesh_of(self);
    for (const MeshAttribute& attribute : mesh.attributes)
        out.append(py::make_tuple(attribute.name, view(dtype_of(attribute.type), mesh.vertices.size(),
                                                       columns_of(attribute.components), attribute.data.data(), self)));
    return out;
}

}  // namespace meniscus::python
