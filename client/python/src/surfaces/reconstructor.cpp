#include "meniscus/reconstructor.hpp"

#include <pybind11/stl.h>

#include <memory>

#include "bindings.hpp"
#include "settings.hpp"
#include "statistics.hpp"
#include "surfaces/device_mesh.hpp"
#include "surfaces/mesh.hpp"
#include "surfaces/shared_reconstructor.hpp"
#include "text_options/backend_options.hpp"
#include "text_options/settings_options.hpp"
#include "threads/ending.hpp"
#include "threads/interpreter_lock.hpp"
#include "threads/process.hpp"
#include "values/device_arrays.hpp"
#include "values/keywords.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

/// Calls hold the content: it lives until they end, whatever becomes of the object.
struct PythonReconstructor {
    std::shared_ptr<SharedReconstructor> content;
};

PythonReconstructor make(const text_options::Options& options) {
    require_own_process();
    rest_at_end();
    auto reader = reader_of(options);
    const BackendOptions backend = text_options::read_backend(reader);
    const Settings settings = text_options::read_settings(reader);
    reader.finish();
    PythonReconstructor made;
    without_lock([&] { made.content = make_in_process<SharedReconstructor>(settings, backend); });
    return made;
}

using Work = SharedReconstructor::Work;

MeshHandle handle_of_work(const Work& work) {
    return {work.mesh, work.content.settings().normals, work.content.statistics()};
}

py::tuple mesh_and_figures(const Work& work) {
    return py::make_tuple(handle_of_work(work), to_dict(work.content.statistics()));
}

py::tuple reconstruct(const PythonReconstructor& self, const py::object& positions, const py::object& levels,
                      const py::sequence& arrays, bool is_last) {
    const auto content = self.content;
    py::tuple result;
    content->run([&](OwnedFrame& frame) { frame.take(given_frame(positions, levels, arrays)); },
                 [is_last](Work& work) {
                     if (is_last)
                         work.content.reconstruct_last(work.frame.frame(), *work.mesh);
                     else
                         work.content.reconstruct(work.frame.frame(), *work.mesh);
                 },
                 [&result](const Work& work) { result = mesh_and_figures(work); });
    return result;
}

py::tuple reconstruct_from_device(const PythonReconstructor& self, const py::dict& positions, const py::object& levels,
                                  const py::sequence& arrays) {
    const auto content = self.content;
    const DeviceArrays particles(positions, levels, arrays);
    py::tuple result;
    content->run([](OwnedFrame&) {},
                 [&particles](Work& work) { work.content.reconstruct(particles.frame(), *work.mesh); },
                 [&result](const Work& work) { result = mesh_and_figures(work); });
    return result;
}

/// make_mesh: on the GPU.
py::tuple device_mesh_and_figures(const std::shared_ptr<SharedReconstructor>& content,
                                  const std::function<void(OwnedFrame&)>& prepare,
                                  const std::function<DeviceMesh(Work&)>& make_mesh) {
    py::tuple result;
    DeviceMesh mesh;
    content->run(
        prepare, [&](Work& work) { mesh = make_mesh(work); },
        [&](const Work& work) {
            result =
                py::make_tuple(DeviceMeshHandle{mesh, content, content->calls()}, to_dict(work.content.statistics()));
        });
    return result;
}

py::tuple device_mesh(const PythonReconstructor& self, const py::object& positions, const py::object& levels,
                      const py::sequence& arrays) {
    const auto content = self.content;
    return device_mesh_and_figures(
        content, [&](OwnedFrame& frame) { frame.take(given_frame(positions, levels, arrays)); },
        [](Work& work) { return work.content.reconstruct_on_device(work.frame.frame()); });
}

py::tuple device_mesh_from_device(const PythonReconstructor& self, const py::dict& positions, const py::object& levels,
                                  const py::sequence& arrays) {
    const auto content = self.content;
    const DeviceArrays particles(positions, levels, arrays);
    return device_mesh_and_figures(
        content, [](OwnedFrame&) {},
        [&particles](Work& work) { return work.content.reconstruct_on_device(particles.frame()); });
}

MeshHandle coarser(const PythonReconstructor& self, const py::object& max_level) {
    const auto level = static_cast<int>(whole_number(max_level, "max_level", 255));
    const auto content = self.content;
    MeshHandle result;
    content->run([](OwnedFrame&) {}, [level](Work& work) { work.content.emit_capped(level, *work.mesh); },
                 [&result](const Work& work) { result = handle_of_work(work); });
    return result;
}

void release_memory(const PythonReconstructor& self) {
    const auto content = self.content;
    content->release_memory();
}

}  // namespace

void bind_reconstructor(py::module_& module) {
    py::class_<PythonReconstructor>(module, "Reconstructor")
        .def_property_readonly("backend", [](const PythonReconstructor& self) { return self.content->backend(); })
        .def("settings", [](const PythonReconstructor& self) { return to_dict(self.content->settings()); })
        .def("reconstruct", &reconstruct, py::arg("positions"), py::arg("levels").none(true), py::arg("arrays"),
             py::arg("is_last"))
        .def("device_mesh", &device_mesh, py::arg("positions"), py::arg("levels").none(true), py::arg("arrays"))
        .def("reconstruct_from_device", &reconstruct_from_device, py::arg("positions"), py::arg("levels").none(true),
             py::arg("arrays"))
        .def("device_mesh_from_device", &device_mesh_from_device, py::arg("positions"), py::arg("levels").none(true),
             py::arg("arrays"))
        .def("coarser", &coarser, py::arg("max_level"))
        .def("release_memory", &release_memory);
    module.def("make_reconstructor", &make, py::arg("options"));
}

}  // namespace meniscus::python
