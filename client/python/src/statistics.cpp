#include "statistics.hpp"

#include "meniscus/names.hpp"
#include "text_out.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

/// Values by the names of a choice.
template <class Choice, class Values>
py::dict by_names(const Values& values) {
    py::dict out;
    for (const Choice choice : choices<Choice>)
        out[py::str(name_of(choice))] = values[static_cast<std::size_t>(choice)];
    return out;
}

py::list warnings_of(const Statistics& statistics) {
    py::list out;
    for (const Warning& warning : statistics.warnings) {
        py::dict told;
        told["code"] = name_of(warning.code);
        told["value"] = warning.value;
        told["limit"] = warning.limit;
        told["text"] = text_out(warning.text);
        out.append(told);
    }
    return out;
}

}  // namespace

py::dict to_dict(const Statistics& statistics) {
    const auto& cells = statistics.base_cells_by_level;
    py::dict out;
    out["particles"] = statistics.particles;
    out["vertices"] = statistics.vertices;
    out["triangles"] = statistics.triangles;
    out["triangles_by_level"] = by_names<TriangleLevel>(statistics.triangles_by_level);
    out["spray_particles"] = statistics.spray_particles;
    out["vertices_without_particles"] = statistics.vertices_without_particles;
    out["volume"] = statistics.volume;
    out["particle_volume"] = statistics.particle_volume;
    out["base_cells_by_level"] = py::make_tuple(cells[0], cells[1], cells[2]);
    out["field_evaluations"] = statistics.field_evaluations;
    out["stage_seconds"] = by_names<Stage>(statistics.stage_seconds);
    out["total_seconds"] = statistics.total_seconds;
    out["download_seconds"] = statistics.download_seconds;
    out["peak_bytes"] = statistics.peak_bytes;
    out["allocations"] = statistics.allocations;
    out["device_bytes"] = statistics.device_bytes;
    out["device_peak_bytes"] = statistics.device_peak_bytes;
    out["backend"] = statistics.backend;
    out["threads"] = statistics.threads;
    out["warnings"] = warnings_of(statistics);
    return out;
}

py::dict to_dict(const client::FrameStatistics& statistics) {
    py::dict out = to_dict(static_cast<const Statistics&>(statistics));
    out["encode_seconds"] = statistics.encode_seconds;
    out["latency_seconds"] = statistics.latency_seconds;
    out["encoded_bytes"] = statistics.encoded_bytes;
    return out;
}

}  // namespace meniscus::python
