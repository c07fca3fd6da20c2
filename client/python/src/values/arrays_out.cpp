#include "values/arrays_out.hpp"

namespace py = pybind11;

namespace meniscus::python {

py::array read_only(py::array array) {
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}

py::array view(const py::dtype& type, std::size_t rows, std::size_t columns, const void* data,
               const py::handle& owner) {
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(rows)};
    if (columns != 0) shape.push_back(static_cast<py::ssize_t>(columns));
    // Without an address numpy would take memory of its own, which the caller could make writable.
    static constexpr std::byte none{};
    return read_only(py::array(type, shape, data == nullptr ? &none : data, owner));
}

py::dtype dtype_of(ElementType type) {
    switch (type) {
        case ElementType::float32:
            return py::dtype::of<float>();
        case ElementType::uint8:
            return py::dtype::of<std::uint8_t>();
        case ElementType::int32:
            return py::dtype::of<std::int32_t>();
        case ElementType::uint32:
            return py::dtype::of<std::uint32_t>();
    }
    return {};
}

}  // namespace meniscus::python
