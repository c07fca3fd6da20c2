#include "sessions/watcher.hpp"

#include "bindings.hpp"
#include "sessions/reconnect_handler.hpp"
#include "text_options/client_options.hpp"
#include "values/keywords.hpp"

namespace py = pybind11;

namespace meniscus::python {

client::WatchOptions watch_options(const text_options::Options& options, const py::object& on_reconnect) {
    auto reader = reader_of(options);
    client::WatchOptions request = text_options::read_watch(reader);
    reader.finish();
    request.on_reconnect = reconnect_handler(on_reconnect);
    return request;
}

client::ParticleWatchOptions particle_watch_options(const text_options::Options& options,
                                                    const py::object& on_reconnect) {
    auto reader = reader_of(options);
    client::ParticleWatchOptions request = text_options::read_particle_watch(reader);
    reader.finish();
    request.on_reconnect = reconnect_handler(on_reconnect);
    return request;
}

void bind_watcher(py::module_& module) {
    bind_source<WatchSource>(module, "Watcher");
    bind_source<ParticleSource>(module, "ParticleWatcher");
}

}  // namespace meniscus::python
