#include "sessions/watcher.hpp"

#include "bindings.hpp"
#include "sessions/reconnect_handler.hpp"
#include "text_options/client_options.hpp"

namespace py = pybind11;

namespace meniscus::python {

client::WatchOptions watch_options(const text_options::Options& options, const py::object& on_reconnect) {
    return request_of(options, on_reconnect, text_options::read_watch);
}

client::ParticleWatchOptions particle_watch_options(const text_options::Options& options,
                                                    const py::object& on_reconnect) {
    return request_of(options, on_reconnect, text_options::read_particle_watch);
}

std::string WatchSource::end_reason() const {
    require_own_process();
    return source_.end_reason();
}

void bind_watcher(py::module_& module) {
    bind_source<WatchSource>(module, "Watcher").def("end_reason", &WatchSource::end_reason);
    bind_source<ParticleSource>(module, "ParticleWatcher");
}

}  // namespace meniscus::python
