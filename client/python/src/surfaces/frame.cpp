#include "surfaces/frame.hpp"

#include <pybind11/numpy.h>

#include <array>
#include <span>
#include <string>
#include <utility>

#include "bindings.hpp"
#include "statistics.hpp"
#include "surfaces/mesh.hpp"
#include "threads/interpreter_lock.hpp"
#include "threads/process.hpp"
#include "values/arrays_out.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

using client::ReceivedFrame;

py::tuple brick_places(std::span<const std::array<std::int32_t, 3>> places) {
    py::tuple out(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) out[i] = py::make_tuple(places[i][0], places[i][1], places[i][2]);
    return out;
}

const char* reason_of(client::DropReason reason) {
    switch (reason) {
        case client::DropReason::replaced:
            return "replaced";
        case client::DropReason::not_nth:
            return "not_nth";
        case client::DropReason::incomplete:
            return "incomplete";
    }
    return "";
}

py::tuple dropped_frames(const ReceivedFrame& frame) {
    py::tuple out(frame.dropped.size());
    for (std::size_t i = 0; i < frame.dropped.size(); ++i)
        out[i] = py::make_tuple(frame.dropped[i].index, reason_of(frame.dropped[i].reason));
    return out;
}

MeshHandle decoded_mesh(const FrameHandle& handle) {
    require_own_process();
    MeshHandle decoded;
    without_lock([&] { decoded.mesh = std::make_shared<const Mesh>(handle.frame->mesh()); });
    decoded.origin = handle.frame;
    return decoded;
}

py::array frame_spray(const FrameHandle& handle) {
    const auto& places = handle.frame->spray;
    auto* const owner = new std::shared_ptr<const ReceivedFrame>(handle.frame);
    const py::capsule kept(owner, [](void* held) { delete static_cast<std::shared_ptr<const ReceivedFrame>*>(held); });
    return view(py::dtype::of<float>(), places.size(), 3, places.data(), kept);
}

py::object range_bounds(const client::FrameAttribute& attribute,
                        const std::array<double, max_attribute_components> AttributeRange::*bound) {
    if (!attribute.range) return py::none();
    py::tuple out(attribute.components);
    for (std::size_t c = 0; c < attribute.components; ++c) out[c] = ((*attribute.range).*bound)[c];
    return out;
}

py::list attribute_forms(const FrameHandle& handle) {
    py::list out;
    for (const client::FrameAttribute& attribute : handle.frame->attributes) {
        py::dict form;
        form["type"] = name_of(attribute.type);
        form["components"] = attribute.components;
        form["minimum"] = range_bounds(attribute, &AttributeRange::minimum);
        form["maximum"] = range_bounds(attribute, &AttributeRange::maximum);
        out.append(py::make_tuple(attribute.name, form));
    }
    return out;
}

}  // namespace

void bind_frame(py::module_& module) {
    py::class_<FrameHandle>(module, "Frame")
        .def_property_readonly("index", [](const FrameHandle& f) { return f.frame->index; })
        .def_property_readonly("run_id", [](const FrameHandle& f) { return f.frame->run_id; })
        .def_property_readonly("time", [](const FrameHandle& f) { return f.frame->simulation_time; })
        .def_property_readonly("cell_size", [](const FrameHandle& f) { return f.frame->cell_size; })
        .def_property_readonly("changed", [](const FrameHandle& f) { return brick_places(f.frame->changed); })
        .def_property_readonly("vanished", [](const FrameHandle& f) { return brick_places(f.frame->vanished); })
        .def_property_readonly("dropped", [](const FrameHandle& f) { return dropped_frames(*f.frame); })
        .def("mesh", &decoded_mesh)
        .def("spray", &frame_spray)
        .def("statistics", [](const FrameHandle& f) { return to_dict(f.frame->statistics); })
        .def("attributes", &attribute_forms);
}

}  // namespace meniscus::python
