#include "sessions/publisher.hpp"

#include <memory>

#include "bindings.hpp"
#include "text_options/client_options.hpp"
#include "threads/ending.hpp"
#include "values/brick_box.hpp"
#include "values/keywords.hpp"

namespace py = pybind11;

namespace meniscus::python {

client::PublisherOptions publisher_options(const text_options::Options& options, const py::object& on_reconnect) {
    return request_of(options, on_reconnect, text_options::read_publisher);
}

std::uint64_t SurfacePublisher::push_mesh(const MeshHandle& mesh, const py::object& index, double time,
                                          const py::object& bricks) {
    require_own_process();
    rest_at_end();
    const Computation encoding;
    return send_in_turn(index_of(index), [this, time, content = mesh.mesh, statistics = statistics_of(mesh),
                                          own = brick_box(bricks, "bricks")](std::uint64_t sent) {
        source_.push(*content, statistics, sent, time, own);
    });
}

std::uint64_t SurfacePublisher::push_frame(const FrameHandle& frame, const py::object& index, double time) {
    require_own_process();
    client::ReceivedFrame content = *frame.frame;  // whose bricks are shared
    content.simulation_time = time;
    return send_in_turn(index_of(index), [this, &content](std::uint64_t sent) {
        content.index = sent;
        source_.push(content);
    });
}

void bind_publisher(py::module_& module) {
    bind_source<SurfacePublisher>(module, "Publisher")
        .def("push_mesh", &SurfacePublisher::push_mesh)
        .def("push_frame", &SurfacePublisher::push_frame)
        .def("finish", &SurfacePublisher::finish)
        .def("dropped", &SurfacePublisher::dropped);
}

}  // namespace meniscus::python
