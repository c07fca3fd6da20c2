// The parts of the extension, each in the file of its name; module.cpp puts them together.
#pragma once

#include <pybind11/pybind11.h>

namespace meniscus::python {

void bind_errors(pybind11::module_& module);
void bind_files(pybind11::module_& module);
void bind_mesh(pybind11::module_& module);
void bind_device_mesh(pybind11::module_& module);
void bind_reconstructor(pybind11::module_& module);
void bind_parts(pybind11::module_& module);
/// What needs a server, or the files that one writes.
void bind_service(pybind11::module_& module);
void bind_frame(pybind11::module_& module);
void bind_particle_frame(pybind11::module_& module);
void bind_reconnect_handlers(pybind11::module_& module);
void bind_stream(pybind11::module_& module);
void bind_publisher(pybind11::module_& module);
void bind_watcher(pybind11::module_& module);
void bind_recording(pybind11::module_& module);
void bind_recording_file(pybind11::module_& module);
void bind_publication(pybind11::module_& module);
void bind_session(pybind11::module_& module);
void bind_client(pybind11::module_& module);

}  // namespace meniscus::python
