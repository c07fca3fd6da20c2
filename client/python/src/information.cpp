#include "information.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <string_view>

#include "row_dict.hpp"
#include "settings.hpp"
#include "statistics.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

std::string_view name_of_wait(client::SessionWait wait) {
    switch (wait) {
        case client::SessionWait::nothing:
            return "nothing";
        case client::SessionWait::device:
            return "device";
        case client::SessionWait::bytes_in_flight:
            return "bytes_in_flight";
        case client::SessionWait::something_else:
            return "something_else";
    }
    return {};
}

/// A datetime with the time zone UTC.
py::object utc(std::chrono::system_clock::time_point time) {
    using std::chrono::microseconds;
    constexpr microseconds end_of_datetime{std::chrono::seconds(253402300799)};  // of the year 9999
    const auto since_1970 = std::chrono::duration_cast<microseconds>(time.time_since_epoch());
    const py::module_ datetime = py::module_::import("datetime");
    const py::object start =
        datetime.attr("datetime")(1970, 1, 1, py::arg("tzinfo") = datetime.attr("timezone").attr("utc"));
    return start + datetime.attr("timedelta")(py::arg("microseconds") = std::min(since_1970, end_of_datetime).count());
}

void describe(py::dict& out, const client::SessionDescription& description) {
    out["name"] = description.name;
    out["up_axis"] = name_of(description.up_axis);
    out["length_unit"] = description.length_unit;
}

}  // namespace

py::dict to_dict(const client::ServerInfo& server) {
    py::dict out;
    out["version"] = server.version;
    out["backend"] = server.backend;
    out["device"] = server.device;
    out["backend_reason"] = server.backend_reason;
    out["threads"] = server.threads;
    out["publishes"] = server.publishes;
    out["checks_published"] = server.checks_published;
    out["limits"] = rows_dict(server);
    return out;
}

py::dict to_dict(const client::SessionInfo& session) {
    py::dict out;
    out["id"] = session.id;
    out["owner"] = session.owner;
    out["settings"] = to_dict(session.settings);
    describe(out, session.description);
    out["ephemeral"] = session.ephemeral;
    out["published"] = session.published;
    out["created_at"] = utc(session.created_at);
    out["uploading"] = session.uploading;
    out["watchers"] = session.watchers;
    out["waits_for"] = name_of_wait(session.waits_for);
    out["waits_for_session"] = session.waits_for_session;
    out["frames"] = session.frames;
    out["frames_dropped"] = session.frames_dropped;
    out["frames_skipped"] = session.frames_skipped;
    out["last_frame_index"] = session.last_frame_index;
    out["last_frame"] = py::none();
    if (session.last_frame) out["last_frame"] = to_dict(*session.last_frame);
    return out;
}

py::dict to_dict(const client::RecordingInfo& recording) {
    py::dict out;
    out["session_id"] = recording.session_id;
    out["number"] = recording.number;
    out["owner"] = recording.owner;
    describe(out, recording.description);
    out["started_at"] = utc(recording.started_at);
    out["frames"] = recording.frames;
    out["first_frame_index"] = recording.first_frame_index;
    out["last_frame_index"] = recording.last_frame_index;
    out["bytes"] = recording.bytes;
    out["being_written"] = recording.being_written;
    out["damaged"] = recording.damaged;
    return out;
}

}  // namespace meniscus::python
