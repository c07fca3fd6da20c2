#include "surfaces/device_mesh.hpp"

#include <stdexcept>
#include <string>
#include <string_view>

#include "bindings.hpp"
#include "formats/containers/npy.hpp"
#include "meniscus/error.hpp"
#include "threads/process.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

constexpr std::string_view attribute_prefix = "attribute ";

/// columns: 0 for an array of one dimension.
py::dict interface(const void* data, std::string_view type, std::size_t rows, std::size_t columns) {
    py::dict out;
    if (columns == 0)
        out["shape"] = py::make_tuple(rows);
    else
        out["shape"] = py::make_tuple(rows, columns);
    out["typestr"] = type;
    // Not said to be read-only, which PyTorch refuses.
    out["data"] = py::make_tuple(reinterpret_cast<std::uintptr_t>(data), false);
    out["strides"] = py::none();
    out["stream"] = py::none();  // complete on every stream
    out["version"] = 3;
    return out;
}

py::tuple names_of(const DeviceMesh& mesh) {
    py::tuple names(mesh.attributes.size());
    for (std::size_t i = 0; i < mesh.attributes.size(); ++i) names[i] = py::str(mesh.attributes[i].name);
    return names;
}

py::dict valid_interface(const DeviceMeshHandle& handle, const std::string& name) {
    require_own_process();
    if (handle.call != handle.owner->calls())
        throw std::runtime_error(
            "this mesh is gone from the GPU: its Reconstructor was used again; copy what is needed "
            "before that");
    return interface_of(handle.mesh, name);
}

}  // namespace

py::dict interface_of(const DeviceMesh& mesh, const std::string& name) {
    if (name == "lattice") return interface(mesh.vertices, "<i4", mesh.vertex_count, 3);
    if (name == "triangles") return interface(mesh.triangles, "<u4", mesh.triangle_count, 3);
    if (name == "normals") {
        if (mesh.normals == nullptr && mesh.vertex_count != 0)
            throw InvalidInput("this mesh has no normals: it was made with normals=False");
        return interface(mesh.normals, "<f4", mesh.vertex_count, 3);
    }
    for (const DeviceMeshAttribute& attribute : mesh.attributes)
        if (name == std::string(attribute_prefix) + attribute.name)
            return interface(attribute.data, formats::npy_name_of(attribute.type), mesh.vertex_count,
                             attribute.components == 1 ? 0 : attribute.components);
    throw InvalidInput("this mesh has no " + name + ": its attributes are " +
                       std::string(py::str(py::repr(names_of(mesh)))));
}

void bind_device_mesh(py::module_& module) {
    py::class_<DeviceMeshHandle>(module, "DeviceMesh")
        .def_property_readonly("attribute_names", [](const DeviceMeshHandle& handle) { return names_of(handle.mesh); })
        .def_property_readonly("cell_size", [](const DeviceMeshHandle& handle) { return handle.mesh.cell_size; })
        .def_property_readonly("offset_bits", [](const DeviceMeshHandle& handle) { return handle.mesh.offset_bits; })
        .def_property_readonly("device", [](const DeviceMeshHandle& handle) { return handle.mesh.device; })
        .def("interface", &valid_interface, py::arg("name"));
}

}  // namespace meniscus::python
