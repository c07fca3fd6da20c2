#include "sessions/particle_frame.hpp"

#include <pybind11/numpy.h>

#include <array>

#include "bindings.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

using client::ReceivedParticles;

py::array_t<float> particle_positions(const ParticleFrameHandle& handle) {
    const ReceivedParticles& particles = *handle.frame;
    const Box& box = particles.quantization_box;
    std::array<double, 3> step{};
    for (std::size_t a = 0; a < 3; ++a) step[a] = (box.max[a] - box.min[a]) / 65535.0;
    py::array_t<float> out({static_cast<py::ssize_t>(particles.quantized.size() / 3), py::ssize_t{3}});
    float* const numbers = out.mutable_data();
    for (std::size_t i = 0; i < particles.quantized.size(); ++i)
        numbers[i] = static_cast<float>(box.min[i % 3] + particles.quantized[i] * step[i % 3]);
    return out;
}

py::object particle_levels(const ParticleFrameHandle& handle) {
    const auto& values = handle.frame->levels;
    if (values.empty()) return py::none();
    return py::array_t<std::uint8_t>(static_cast<py::ssize_t>(values.size()), values.data());
}

}  // namespace

void bind_particle_frame(py::module_& module) {
    py::class_<ParticleFrameHandle>(module, "ParticleFrame")
        .def_property_readonly("index", [](const ParticleFrameHandle& f) { return f.frame->index; })
        .def_property_readonly("run_id", [](const ParticleFrameHandle& f) { return f.frame->run_id; })
        .def_property_readonly("time", [](const ParticleFrameHandle& f) { return f.frame->simulation_time; })
        .def_property_readonly("frame_count", [](const ParticleFrameHandle& f) { return f.frame->frame_count; })
        .def_property_readonly("stride", [](const ParticleFrameHandle& f) { return f.frame->stride; })
        .def_property_readonly("particle_radius", [](const ParticleFrameHandle& f) { return f.frame->particle_radius; })
        .def("positions", &particle_positions)
        .def("levels", &particle_levels);
}

}  // namespace meniscus::python
