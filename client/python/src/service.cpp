#include "bindings.hpp"

namespace meniscus::python {

void bind_service(pybind11::module_& module) {
    bind_frame(module);
    bind_particle_frame(module);
    bind_reconnect_handlers(module);
    bind_stream(module);
    bind_publisher(module);
    bind_watcher(module);
    bind_recording(module);
    bind_recording_file(module);
    bind_publication(module);
    bind_session(module);
    bind_client(module);
}

}  // namespace meniscus::python
