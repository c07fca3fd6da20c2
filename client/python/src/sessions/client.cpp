#include "meniscus/client/client.hpp"

#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "information.hpp"
#include "meniscus/client/session_lookup.hpp"
#include "sessions/opening.hpp"
#include "sessions/session.hpp"
#include "text_options/client_options.hpp"
#include "text_options/settings_options.hpp"
#include "values/keywords.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

using client::Client;
using text_options::Options;

/// The class _meniscus.Client.
class Connected {
public:
    explicit Connected(std::shared_ptr<Client> client) : client_(std::move(client)) {}

    /// For one call, which a close() from another thread does not take it from. Throws InvalidInput once it is closed.
    std::shared_ptr<Client> open() const {
        if (!client_) throw InvalidInput("this client was closed: make another one");
        return client_;
    }
    void close() { client_.reset(); }

private:
    std::shared_ptr<Client> client_;  ///< with the interpreter's lock; none once closed
};

Held<Connected> connected_client(const py::object& given_address, const Options& options) {
    const std::string address = text_of(given_address, "address");
    auto reader = reader_of(options);
    client::ConnectionOptions connection = text_options::read_connection(reader);
    reader.finish();
    return call_server([&](const std::stop_token& stop) {
        connection.stop = stop;
        return hold(Connected(std::shared_ptr<Client>(new Client(address, connection), WaitingDelete())));
    });
}

/// call(client, stop).
template <class Call>
auto call_client(const Connected& connected, const Call& call) {
    const std::shared_ptr<Client> client = connected.open();
    return call_server([&](const std::stop_token& stop) { return call(*client, stop); });
}

py::list to_list(const auto& records) {
    py::list out;
    for (const auto& one : records) out.append(to_dict(one));
    return out;
}

Held<HeldSession> open_session(const Connected& connected, const Options& options) {
    auto reader = reader_of(options);
    const Settings settings = text_options::read_settings(reader);
    client::OpenOptions open = text_options::read_open(reader);
    reader.finish();
    return call_client(connected, [&](Client& client, const std::stop_token& stop) {
        open.stop = stop;
        return Held<HeldSession>(new HeldSession(client.open_session(settings, open)));
    });
}

py::object snapshot(const Connected& connected, const py::object& given, const Options& options) {
    const std::string session = text_of(given, "session");
    auto reader = reader_of(options);
    client::SnapshotOptions request = text_options::read_snapshot(reader);
    reader.finish();
    auto frame = call_client(connected, [&](Client& client, const std::stop_token& stop) {
        request.stop = stop;
        return client.snapshot(client::session_id_of(client, session, stop), request);
    });
    if (!frame) return py::none();
    return py::cast(handle_of(std::move(*frame)));
}

std::uint32_t recording_number(const py::object& given) {
    return static_cast<std::uint32_t>(whole_number(given, "number", std::numeric_limits<std::uint32_t>::max()));
}

Held<RecordingSource> read_recording(const Connected& connected, const py::object& given, const py::object& number,
                                     const py::object& position, const py::object& count, bool spray,
                                     const py::object& normals_by) {
    constexpr std::uint64_t largest = std::numeric_limits<std::uint64_t>::max();
    const std::string session = text_of(given, "session");
    const std::uint32_t which = recording_number(number);
    client::ReadOptions request{.position = whole_number(position, "position", largest),
                                .count = whole_number(count, "count", largest),
                                .spray = spray};
    request.normals_by = by_name<client::NormalsBy>(text_of(normals_by, "normals_by"), "normals_by");
    return call_client(connected, [&](Client& client, const std::stop_token& stop) {
        request.stop = stop;
        const std::string id = client::recorded_session_id_of(client, session, stop);
        return Held<RecordingSource>(new RecordingSource(client.read_recording(id, which, request)));
    });
}

}  // namespace

void bind_client(py::module_& module) {
    using Stop = std::stop_token;
    module.def("connect", &connected_client);
    py::class_<Connected, Held<Connected>>(module, "Client")
        .def(
            "info",
            [](const Connected& connected) {
                return to_dict(call_client(connected, [](Client& c, const Stop& stop) { return c.server_info(stop); }));
            })
        .def("serving",
             [](const Connected& connected) {
                 return call_client(connected, [](Client& c, const Stop& stop) { return c.serving(stop); });
             })
        .def("open_session", &open_session)
        .def("sessions",
             [](const Connected& connected) {
                 return to_list(call_client(connected, [](Client& c, const Stop& stop) { return c.sessions(stop); }));
             })
        .def("session_info",
             [](const Connected& connected, const py::object& given) {
                 const std::string session = text_of(given, "session");
                 return to_dict(call_client(connected, [&](Client& c, const Stop& stop) {
                     return c.session(client::session_id_of(c, session, stop), stop);
                 }));
             })
        .def("delete_session",
             [](const Connected& connected, const py::object& given, bool unpublish) {
                 const std::string session = text_of(given, "session");
                 call_client(connected, [&](Client& c, const Stop& stop) {
                     c.delete_session(client::session_id_of(c, session, stop), {.unpublish = unpublish}, stop);
                 });
             })
        .def("stream",
             [](const Connected& connected, const py::object& given, const Options& options,
                const py::object& on_reconnect) {
                 const std::shared_ptr<Client> client = connected.open();
                 return open_stream(
                     options, on_reconnect, [&, session = text_of(given, "session")](const auto& request) {
                         return client->stream(client::session_id_of(*client, session, request.stop), request);
                     });
             })
        .def("publish",
             [](const Connected& connected, const py::object& given, const Options& options,
                const py::object& on_reconnect) {
                 const std::shared_ptr<Client> client = connected.open();
                 return open_publisher(
                     options, on_reconnect, [&, session = text_of(given, "session")](const auto& request) {
                         return client->publish(client::session_id_of(*client, session, request.stop), request);
                     });
             })
        .def("watch",
             [](const Connected& connected, const py::object& given, const Options& options,
                const py::object& on_reconnect) {
                 const std::shared_ptr<Client> client = connected.open();
                 return open_watcher(
                     options, on_reconnect, [&, session = text_of(given, "session")](const auto& request) {
                         return client->watch(client::session_id_of(*client, session, request.stop), request);
                     });
             })
        .def("watch_particles",
             [](const Connected& connected, const py::object& given, const Options& options,
                const py::object& on_reconnect) {
                 const std::shared_ptr<Client> client = connected.open();
                 return open_particle_watcher(
                     options, on_reconnect, [&, session = text_of(given, "session")](const auto& request) {
                         return client->watch_particles(client::session_id_of(*client, session, request.stop), request);
                     });
             })
        .def("snapshot", &snapshot)
        .def("recordings",
             [](const Connected& connected) {
                 return to_list(call_client(connected, [](Client& c, const Stop& stop) { return c.recordings(stop); }));
             })
        .def("read_recording", &read_recording)
        .def("delete_recording",
             [](const Connected& connected, const py::object& given, const py::object& number) {
                 const std::string session = text_of(given, "session");
                 const std::uint32_t which = recording_number(number);
                 call_client(connected, [&](Client& c, const Stop& stop) {
                     c.delete_recording(client::recorded_session_id_of(c, session, stop), which, stop);
                 });
             })
        .def("close", &Connected::close);
}

}  // namespace meniscus::python
