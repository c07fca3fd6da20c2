#include "surfaces/mesh.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <string>

#include "bindings.hpp"
#include "formats/meshes/mesh_content.hpp"
#include "formats/meshes/mesh_formats.hpp"
#include "formats/meshes/triangle_mesh.hpp"
#include "formats/pictures/png.hpp"
#include "formats/recordings/brick_file.hpp"
#include "meniscus/attribute_coding.hpp"
#include "meniscus/canonical_order.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh_hash.hpp"
#include "picture/picture.hpp"
#include "surfaces/mesh_arrays.hpp"
#include "surfaces/mesh_measures.hpp"
#include "surfaces/mesh_state.hpp"
#include "threads/ending.hpp"
#include "threads/interpreter_lock.hpp"
#include "threads/process.hpp"
#include "values/arrays_out.hpp"
#include "values/keywords.hpp"
#include "values/paths.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

/// In world units, each rounded once to float64, and for float32 once more.
template <class Number>
py::array vertices(const py::object& self) {
    const Mesh& mesh = mesh_of(self);
    return filled_array<Number>(mesh.vertices.size(), 3, [&mesh](Number* out) {
        without_lock([&] {
            for (const LatticePosition& position : mesh.vertices)
                for (const double coordinate : mesh.world(position)) *out++ = static_cast<Number>(coordinate);
        });
    });
}

py::array levels(const py::object& self) {
    const Mesh& mesh = mesh_of(self);
    return filled_array<std::uint8_t>(mesh.triangles.size(), 0, [&mesh](std::uint8_t* out) {
        std::fill_n(out, mesh.triangles.size(), level_byte(TriangleLevel::crack));
        for (const TriangleLevel level : choices<TriangleLevel>) {
            const TriangleRange range = mesh.levels[static_cast<std::size_t>(level)];
            std::fill_n(out + range.first, range.count, level_byte(level));
        }
    });
}

/// measure: area_of or volume_of.
double measured(const MeshHandle& handle, double (*measure)(const Mesh&)) {
    require_own_process();
    double result = 0.0;
    without_lock([&] { result = measure(*handle.mesh); });
    return result;
}

py::bytes png(const MeshHandle& handle, const py::object& width, const py::object& height, const std::string& color,
              const std::string& up, bool wireframe) {
    require_own_process();
    rest_at_end();
    const Computation computation;
    constexpr std::uint64_t largest_side = 8192;
    cli::PictureOptions options;
    options.width = whole_number(width, "width", largest_side);
    options.height = whole_number(height, "height", largest_side);
    if (options.width == 0 || options.height == 0)
        throw InvalidInput("a picture of " + std::to_string(options.width) + " x " + std::to_string(options.height) +
                           " pixels has none, must have at least one");
    options.color = color;
    options.up = by_name<cli::UpAxis>(up, "up");
    options.wireframe = wireframe;
    std::string bytes;
    without_lock([&] {
        bytes = formats::png_bytes(cli::draw_picture(formats::to_triangles(in_canonical_order(*handle.mesh)), options));
    });
    return bytes;
}

/// digits: of a mesh, such as mesh_sha256.
template <std::string (*digits)(const Mesh&)>
std::string hash_of(const MeshHandle& handle) {
    require_own_process();
    rest_at_end();
    const Computation computation;
    std::string hash;
    without_lock([&] { hash = digits(*handle.mesh); });
    return hash;
}

/// The mesh encoded as the command line does with one of its own: exact attributes, normals of the default.
client::ReceivedFrame encoded(const Mesh& mesh, const Statistics& statistics) {
    CodingOptions coding;
    const std::vector<AttributeWish> exact{{.name = {}, .bits = 0}};
    coding.attributes = coded_attributes(mesh, attribute_ranges(mesh), exact);
    return client::encode_frame(mesh, statistics, 0, 0.0, coding);
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
        .def_property_readonly("lattice", &lattice_view)
        .def_property_readonly("triangles", &triangles_view)
        .def_property_readonly("normals", &normals_view)
        .def_property_readonly("spray", &spray_view)
        .def_property_readonly("cell_size", [](const MeshHandle& handle) { return handle.mesh->cell_size; })
        .def_property_readonly("offset_bits", [](const MeshHandle& handle) { return handle.mesh->offset_bits; })
        .def("vertices", &vertices<double>)
        .def("vertices32", &vertices<float>)
        .def("levels", &levels)
        .def("attributes", &attribute_views)
        .def("area", [](const MeshHandle& handle) { return measured(handle, &area_of); })
        .def("volume", [](const MeshHandle& handle) { return measured(handle, &volume_of); })
        .def("png", &png, py::arg("width"), py::arg("height"), py::arg("color"), py::arg("up"), py::arg("wireframe"))
        .def("state", &state_of)
        .def("sha256", &hash_of<mesh_sha256>)
        .def("bricks_sha256", &hash_of<bricks_sha256>)
        .def("save", &save, py::arg("path"));
    module.def("restore_mesh", &mesh_of_state, py::arg("state"));
}

}  // namespace meniscus::python
