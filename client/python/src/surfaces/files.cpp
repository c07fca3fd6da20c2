#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "bindings.hpp"
#include "formats/containers/array_collector.hpp"
#include "formats/meshes/mesh_formats.hpp"
#include "formats/particles/particle_file.hpp"
#include "text_out.hpp"
#include "threads/ending.hpp"
#include "threads/interpreter_lock.hpp"
#include "threads/process.hpp"
#include "values/arrays_out.hpp"
#include "values/paths.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

formats::Particles read(const std::filesystem::path& path, const formats::ReadLimits& limits) {
    const formats::ParticleFormat format = formats::particle_format_of(path);
    check_size(path, limits.most_bytes);
    // HDF5's library, which h5py may use at the same time, is not safe against a second thread.
    if (format == formats::ParticleFormat::hdf5) return formats::read_particles(path, format, limits);
    formats::Particles particles;
    without_lock([&] { particles = formats::read_particles(path, format, limits); });
    return particles;
}

py::tuple read_particles(const py::object& path, const py::object& max_bytes) {
    require_own_process();
    rest_at_end();
    const Computation computation;
    formats::Particles particles = read(path_of(path), {.most_bytes = size_limit(max_bytes)});
    py::object levels = py::none();
    if (!particles.levels.empty()) levels = array_of(std::move(particles.levels), py::dtype::of<std::uint8_t>(), 0);
    py::list arrays;
    for (formats::NamedValues& values : particles.arrays)
        arrays.append(py::make_tuple(
            values.name, array_of(std::move(values.data), dtype_of(values.type), columns_of(values.components)),
            text_out(values.label.empty() ? values.name : values.label)));
    py::object warning = py::none();
    if (particles.faces != 0)
        warning = py::str(formats::corners_as_particles(particles.faces, particles.positions.size() / 3));
    py::list left_out;
    for (const std::string& line : particles.left_out) left_out.append(text_out(line));
    return py::make_tuple(array_of(std::move(particles.positions), py::dtype::of<float>(), 3), levels, arrays, left_out,
                          warning);
}

py::list as_list(std::span<const std::string_view> texts) {
    py::list out;
    for (const std::string_view text : texts) out.append(py::str(text.data(), text.size()));
    return out;
}

}  // namespace

void bind_files(py::module_& module) {
    module.def("read_particles", &read_particles, py::arg("path"), py::arg("max_bytes"));
    module.def("array_name", &formats::array_name, py::arg("name"));
    module.def("particle_extensions", [] { return as_list(formats::particle_extensions()); });
    module.def("mesh_extensions", [] { return as_list(formats::mesh_extensions()); });
}

}  // namespace meniscus::python
