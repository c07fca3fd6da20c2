#include "surfaces/mesh_state.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "meniscus/error.hpp"
#include "meniscus/particle_frame.hpp"
#include "surfaces/figures.hpp"
#include "surfaces/mesh_arrays.hpp"
#include "values/arrays_in.hpp"
#include "values/arrays_out.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

/// A brick as whole numbers: its coordinate, and first and count of each range.
constexpr std::size_t brick_numbers = 3 + 2 * triangle_level_count;
static_assert(sizeof(MeshBrick) == brick_numbers * sizeof(std::int32_t) && std::is_trivially_copyable_v<MeshBrick>);

[[noreturn]] void refuse(const std::string& what) {
    throw InvalidInput("the pickled mesh is damaged: " + what);
}

Statistics read_figures(const std::string& bytes) {
    const std::optional<Statistics> figures = figures_of(bytes);
    if (!figures) refuse("its figures are no message");
    return *figures;
}

py::object part(const py::dict& state, const char* name) {
    if (!state.contains(name)) refuse(std::string("it has no '") + name + "'");
    return state[name];
}

template <class Value>
Value value(const py::dict& state, const char* name) {
    try {
        return py::cast<Value>(part(state, name));
    } catch (const py::cast_error&) {
        refuse(std::string("its '") + name + "' is of another type");
    }
}

/// Copies an array of rows of `columns` numbers into one of such rows.
template <class Number, class Row>
void take(const py::dict& state, const char* name, Array<Row>& rows) {
    static_assert(std::is_trivially_copyable_v<Row> && sizeof(Row) % sizeof(Number) == 0);
    const auto array = value<py::array>(state, name);
    const auto columns = static_cast<py::ssize_t>(sizeof(Row) / sizeof(Number));
    if (array.ndim() != 2 || array.shape(1) != columns || !is_of(array, py::dtype::of<Number>()))
        refuse(std::string("its '") + name + "' has another form");
    rows.resize(static_cast<std::size_t>(array.shape(0)));
    if (!rows.empty()) std::memcpy(static_cast<void*>(rows.data()), array.data(), rows.size() * sizeof(Row));
}

bool fits(const TriangleRange& range, std::size_t triangles) {
    return range.first <= triangles && range.count <= triangles - range.first;
}

void check_triangles(const Mesh& mesh) {
    const std::size_t vertices = mesh.vertices.size();
    for (const Triangle& triangle : mesh.triangles)
        if (std::ranges::any_of(triangle, [vertices](std::uint32_t corner) { return corner >= vertices; }))
            refuse("a triangle has a corner that is no vertex");
    const auto fit = [&mesh](const TriangleRange& range) { return fits(range, mesh.triangles.size()); };
    const bool are_ranges =
        std::ranges::all_of(mesh.levels, fit) && std::ranges::all_of(mesh.bricks, [&fit](const MeshBrick& brick) {
            return std::ranges::all_of(brick.ranges, fit);
        });
    if (!are_ranges) refuse("a level or a brick has triangles that are not there");
}

void take_attributes(const py::dict& state, Mesh& mesh) {
    for (const auto& [name, array] : value<std::vector<std::pair<std::string, py::array>>>(state, "attributes")) {
        const auto type = element_type_of(array);
        const std::size_t components = array.ndim() == 2 ? static_cast<std::size_t>(array.shape(1)) : 1;
        const bool has_form = (array.ndim() == 1 || array.ndim() == 2) && type && can_be_attribute(*type, components);
        if (!has_form || static_cast<std::size_t>(array.shape(0)) != mesh.vertices.size() || !is_c_order(array))
            refuse("the attribute '" + name + "' has another form");
        MeshAttribute& attribute = mesh.attributes.emplace_back();
        attribute.name = name;
        attribute.type = *type;
        attribute.components = components;
        const auto* const bytes = static_cast<const std::byte*>(array.data());
        attribute.data.assign(bytes, bytes + array.nbytes());
    }
}

std::array<TriangleRange, triangle_level_count> levels_of(const py::dict& state) {
    std::array<TriangleRange, triangle_level_count> levels{};
    const auto given =
        value<std::array<std::pair<std::uint32_t, std::uint32_t>, triangle_level_count>>(state, "levels");
    std::ranges::transform(given, levels.begin(), [](const auto& range) {
        return TriangleRange{.first = range.first, .count = range.second};
    });
    return levels;
}

}  // namespace

py::dict state_of(const py::object& self) {
    const auto& handle = py::cast<const MeshHandle&>(self);
    const Mesh& mesh = *handle.mesh;
    py::tuple levels(mesh.levels.size());
    for (std::size_t i = 0; i < mesh.levels.size(); ++i)
        levels[i] = py::make_tuple(mesh.levels[i].first, mesh.levels[i].count);
    py::dict state;
    state["cell_size"] = mesh.cell_size;
    state["offset_bits"] = mesh.offset_bits;
    state["lattice"] = lattice_view(self);
    state["triangles"] = triangles_view(self);
    state["normals"] = normals_view(self);
    state["levels"] = levels;
    state["bricks"] = view(py::dtype::of<std::int32_t>(), mesh.bricks.size(), brick_numbers, mesh.bricks.data(), self);
    state["attributes"] = attribute_views(self);
    state["spray"] = spray_view(self);
    state["figures"] = py::bytes(figure_bytes(statistics_of(handle)));
    return state;
}

MeshHandle mesh_of_state(const py::dict& state) {
    const auto made = std::make_shared<Mesh>();
    Mesh& mesh = *made;
    mesh.cell_size = value<double>(state, "cell_size");
    mesh.offset_bits = value<std::uint32_t>(state, "offset_bits");
    if (!std::isfinite(mesh.cell_size) || mesh.cell_size <= 0.0 || mesh.offset_bits > max_offset_bits)
        refuse("its lattice is none");
    take<std::int32_t>(state, "lattice", mesh.vertices);
    take<std::uint32_t>(state, "triangles", mesh.triangles);
    const bool has_normals = !part(state, "normals").is_none();
    if (has_normals) take<float>(state, "normals", mesh.normals);
    if (has_normals && mesh.normals.size() != mesh.vertices.size()) refuse("it has not one normal for each vertex");
    mesh.levels = levels_of(state);
    take<std::int32_t>(state, "bricks", mesh.bricks);
    check_triangles(mesh);
    take_attributes(state, mesh);
    take<float>(state, "spray", mesh.spray);
    return {made, has_normals, read_figures(value<std::string>(state, "figures"))};
}

}  // namespace meniscus::python
