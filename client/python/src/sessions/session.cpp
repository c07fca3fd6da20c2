#include "sessions/session.hpp"

#include "bindings.hpp"
#include "information.hpp"
#include "sessions/opening.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

using client::Session;
using text_options::Options;

/// call(session, stop), in the session's turn.
template <class Call>
auto call_session(HeldSession& held, const Call& call) {
    return call_server([&](const std::stop_token& stop) {
        return held.in_turn(stop, [&](Session& session) { return call(session, stop); });
    });
}

/// With options that have a token.
template <class Call>
auto opened(HeldSession& held, const Call& call) {
    return [&held, &call](const auto& request) {
        return held.in_turn(request.stop, [&](Session& session) { return call(session, request); });
    };
}

}  // namespace

void bind_session(py::module_& module) {
    py::class_<HeldSession, Held<HeldSession>>(module, "Session")
        .def_property_readonly("id", &HeldSession::id)
        .def_property_readonly("is_owned",
                               [](HeldSession& held) {
                                   return call_session(held,
                                                       [](Session& s, const std::stop_token&) { return s.is_owned(); });
                               })
        .def("info",
             [](HeldSession& held) {
                 return to_dict(
                     call_session(held, [](Session& s, const std::stop_token& stop) { return s.info(stop); }));
             })
        .def("stream",
             [](HeldSession& held, const Options& options, const py::object& on_reconnect) {
                 const auto open = [](Session& s, const client::StreamOptions& request) { return s.stream(request); };
                 return open_stream(options, on_reconnect, opened(held, open));
             })
        .def("publish",
             [](HeldSession& held, const Options& options, const py::object& on_reconnect) {
                 const auto open = [](Session& s, const client::PublisherOptions& request) {
                     return s.publish(request);
                 };
                 return open_publisher(options, on_reconnect, opened(held, open));
             })
        .def("watch",
             [](HeldSession& held, const Options& options, const py::object& on_reconnect) {
                 const auto open = [](Session& s, const client::WatchOptions& request) { return s.watch(request); };
                 return open_watcher(options, on_reconnect, opened(held, open));
             })
        .def("watch_particles",
             [](HeldSession& held, const Options& options, const py::object& on_reconnect) {
                 const auto open = [](Session& s, const client::ParticleWatchOptions& request) {
                     return s.watch_particles(request);
                 };
                 return open_particle_watcher(options, on_reconnect, opened(held, open));
             })
        .def("leave",
             [](HeldSession& held) { call_session(held, [](Session& s, const std::stop_token&) { s.leave(); }); })
        .def("end", [](HeldSession& held) {
            call_session(held, [](Session& s, const std::stop_token& stop) { s.end(stop); });
        });
}

}  // namespace meniscus::python
