#include "surfaces/mesh.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <string>

#include "bindings.hpp"
#include "formats/meshes/mesh_content.hpp"
#include "formats/meshes/mesh_formats.hpp"
#include "formats/recordings/brick_file.hpp"
#include "meniscus/attribute_coding.hpp"
#include "meniscus/canonical_order.hpp"
#include "meniscus/mesh_hash.hpp"
#include "threads/ending.hpp"
#include "threads/interpreter_lock.hpp"
#include "threads/process.hpp"
#include "values/arrays_out.hpp"
#include "values/paths.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

const Mesh& mesh_of(const py::object& self) {
    return *py::cast<const MeshHandle&>(self).mesh;
}

py::array lattice(const py::object& self) {
    const Mesh& mesh = mesh_of(self);
    return view(py::dtype::of<std::int32_t>(), mesh.vertices.size(), 3, mesh.vertices.data(), self);
}

py::array triangles(const py::object& self) {
    const Mesh& mesh = mesh_of(self);
    return view(py::dtype::of<std::uint32_t>(), mesh.triangles.size(), 3, mesh.triangles.data(), self);
}

py::object normals(const py::object& self) {
    const auto& handle = py::cast<const MeshHandle&>(self);
    const Mesh& mesh = *handle.mesh;
    const bool has_normals = mesh.vertices.empty() ? handle.has_normals : !mesh.normals.empty();
    if (!has_normals) return py::none();
    return view(py::dtype::of<float>(), mesh.normals.size(), 3, mesh.normals.data(), self);
}

py::array spray(const py::object& self) {
    const Mesh& mesh = mesh_of(self);
    return view(py::dtype::of<float>(), mesh.spray.size(), 3, mesh.spray.data(), self);
}

py::array vertices(const py::object& self) {
    const Mesh& mesh = mesh_of(self);
    py::array_t<double> out(std::vector<py::ssize_t>{static_cast<py::ssize_t>(mesh.vertices.size()), 3});
    auto* const places = reinterpret_cast<std::array<double, 3>*>(out.mutable_data());
    without_lock([&] {
        std::transform(mesh.vertices.begin(), mesh.vertices.end(), places,
                       [&mesh](const LatticePosition& position) { return mesh.world(position); });
    });
    return read_only(std::move(out));
}

py::array levels(const py::object& self) {
    const Mesh& mesh = mesh_of(self);
    py::array_t<std::uint8_t> out(static_cast<py::ssize_t>(mesh.triangles.size()));
    for (const TriangleLevel level : choices<TriangleLevel>) {
        const TriangleRange range = mesh.levels[static_cast<std::size_t>(level)];
        std::fill_n(out.mutable_data() + range.first, range.count, level_byte(level));
    }
    return read_only(std::move(out));
}

py::list attributes(const py::object& self) {
    py::list out;
    const Mesh& mesh = mesh_of(self);
    for (const MeshAttribute& attribute : mesh.attributes)
        out.append(py::make_tuple(attribute.name, view(dtype_of(attribute.type), mesh.vertices.size(),
                                                       columns_of(attribute.components), attribute.data.data(), self)));
    return out;
}

std::string sha256(const MeshHandle& handle) {
    require_own_process();
    rest_at_end();
    const Computation computation;
    std::string hash;
    without_lock([&] { hash = mesh_sha256(*handle.mesh); });
    return hash;
}

/// The mesh encoded as the command line does with one of its own: exact attributes, normals of the default.
client::ReceivedFrame encoded(const Mesh& mesh, const Statistics& statistics) {
    CodingOptions coding;
    const std::vector<AttributeWish> exact{{.name = {}, .bits = 0}};
    coding.attributes = coded_attributes(mesh, attribute_ranges(mesh), exact);
    return formats::encode_frame(mesh, statistics, 0, 0.0, coding);
}

void write_bricks(const std::filesystem::path& path, const MeshHandle& handle) {
    if (const auto* received = std::get_if<std::shared_ptr<const client::ReceivedFrame>>(&handle.origin))
        return formats::write_bricks(path, **received);
    formats::write_bricks(path, encoded(*handle.mesh, std::get<Statistics>(handle.origin)));
}

void save(const MeshHandle& handle, const py::object& path) {
    require_own_process();
    rest_at_end();
    const Computation computation;
    const std::filesystem::path file = path_of(path);
    without_lock([&] {
        const formats::MeshFormat format = formats::mesh_format_of(file);
        if (format == formats::MeshFormat::bricks) return write_bricks(file, handle);
        formats::MeshContent(in_canonical_order(*handle.mesh), format).write(file);
    });
}

}  // namespace

void bind_mesh(py::module_& module) {
    py::class_<MeshHandle>(module, "Mesh")
        .def_property_readonly("lattice", &lattice)
        .def_property_readonly("triangles", &triangles)
        .def_property_readonly("normals", &normals)
        .def_property_readonly("spray", &spray)
        .def_property_readonly("cell_size", [](const MeshHandle& handle) { return handle.mesh->cell_size; })
        .def_property_readonly("offset_bits", [](const MeshHandle& handle) { return handle.mesh->offset_bits; })
        .def("vertices", &vertices)
        .def("levels", &levels)
        .def("attributes", &attributes)
        .def("sha256", &sha256)
        .def("save", &save, py::arg("path"));
}

}  // namespace meniscus::python
