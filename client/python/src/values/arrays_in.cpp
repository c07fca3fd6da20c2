#include "values/arrays_in.hpp"

#include "meniscus/error.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

/// The type and the shape of the array, in words.
std::string form_of(const py::array& array) {
    return std::string(py::str(array.dtype())) + " of the shape " + std::string(py::str(array.attr("shape")));
}

py::array as_array(const py::handle& value, const std::string& what) {
    if (!py::isinstance<py::array>(value))
        throw InvalidInput(what + " is " + Py_TYPE(value.ptr())->tp_name + ", must be a numpy array");
    return py::reinterpret_borrow<py::array>(value);
}

/// In the machine's byte order.
template <class Number>
bool holds(const py::array& array) {
    return array.dtype().equal(py::dtype::of<Number>());
}

StridedPositions positions_of(const py::array& array) {
    const bool is_float64 = holds<double>(array);
    const bool has_form = array.ndim() == 2 && array.shape(1) == 3 && (is_float64 || holds<float>(array));
    const auto bytes = static_cast<py::ssize_t>(array.itemsize());
    // numpy's strides say nothing for one particle or none.
    const bool has_order =
        has_form && array.strides(1) == bytes && (array.shape(0) < 2 || array.strides(0) >= 3 * bytes);
    if (!has_order && !(has_form && array.shape(0) == 0))
        throw InvalidInput("positions is " + form_of(array) +
                           ", must be (N, 3) of float32 or float64, the numbers of a particle next to each other");
    const auto count = static_cast<std::size_t>(array.shape(0));
    const auto stride = static_cast<std::size_t>(count < 2 ? 3 * bytes : array.strides(0));
    if (is_float64) return {static_cast<const double*>(array.data()), count, stride};
    return {static_cast<const float*>(array.data()), count, stride};
}

std::span<const std::uint8_t> levels_of(const py::object& levels) {
    if (levels.is_none()) return {};
    const py::array array = as_array(levels, "levels");
    if (array.ndim() != 1 || !holds<std::uint8_t>(array) || !is_c_order(array))
        throw InvalidInput("levels is " + form_of(array) + ", must be (N,) of uint8 in C order");
    return {static_cast<const std::uint8_t*>(array.data()), static_cast<std::size_t>(array.size())};
}

ParticleArray values_of(const std::string& name, const py::array& array) {
    const std::optional<ElementType> type = element_type_of(array);
    const bool has_form = array.ndim() == 1 || (array.ndim() == 2 && array.shape(1) > 0);
    if (!type || !has_form || !is_c_order(array))
        throw InvalidInput("the attribute '" + name + "' is " + form_of(array) +
                           ", must be (N,) or (N, components) of float32, uint8, int32 or uint32 in C order");
    return {{},
            {static_cast<const std::byte*>(array.data()), static_cast<std::size_t>(array.nbytes())},
            *type,
            array.ndim() == 1 ? 1 : static_cast<std::size_t>(array.shape(1))};
}

void check_length(const std::string& what, std::size_t length, std::size_t particles) {
    if (length != particles)
        throw InvalidInput(what + " has " + std::to_string(length) + " entries, must have one for each of the " +
                           std::to_string(particles) + " particles");
}

}  // namespace

bool is_c_order(const py::array& array) {
    return (array.flags() & py::array::c_style) != 0;
}

bool is_of(const py::array& array, const py::dtype& type) {
    return array.dtype().equal(type) && is_c_order(array);
}

std::optional<ElementType> element_type_of(const py::array& array) {
    if (holds<float>(array)) return ElementType::float32;
    if (holds<std::uint8_t>(array)) return ElementType::uint8;
    if (holds<std::int32_t>(array)) return ElementType::int32;
    if (holds<std::uint32_t>(array)) return ElementType::uint32;
    return std::nullopt;
}

GivenFrame given_frame(const py::object& positions, const py::object& levels, const py::sequence& arrays) {
    GivenFrame given{positions_of(as_array(positions, "positions")), levels_of(levels), {}, {}};
    const std::size_t particles = given.positions.count();
    if (!levels.is_none()) check_length("levels", given.levels.size(), particles);
    for (const py::handle pair : arrays) {
        const auto [name, values] = py::cast<std::pair<std::string, py::object>>(pair);
        const std::string what = "the attribute '" + name + "'";
        const ParticleArray array = values_of(name, as_array(values, what));
        check_length(what, array.data.size() / array.element_bytes(), particles);
        given.names.push_back(name);
        given.arrays.push_back(array);
    }
    for (std::size_t i = 0; i < given.arrays.size(); ++i) given.arrays[i].name = given.names[i];
    return given;
}

void OwnedFrame::take(const GivenFrame& given) {
    positions_.resize(3 * given.positions.count());
    given.positions.copy_to(positions_);
    levels_.assign(given.levels.begin(), given.levels.end());
    names_ = given.names;
    arrays_ = given.arrays;
    values_.resize(arrays_.size());
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
        values_[i].assign(given.arrays[i].data.begin(), given.arrays[i].data.end());
        arrays_[i].data = values_[i];
        arrays_[i].name = names_[i];
    }
}

ParticleFrame OwnedFrame::frame() const {
    ParticleFrame frame;
    frame.positions = positions_;
    frame.levels = levels_;
    frame.arrays = arrays_;
    return frame;
}

}  // namespace meniscus::python
