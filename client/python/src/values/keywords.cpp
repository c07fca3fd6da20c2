#include "values/keywords.hpp"

#include <algorithm>
#include <limits>

#include "meniscus/error.hpp"

namespace py = pybind11;

namespace meniscus::python {

std::string keyword_of(std::string_view option) {
    if (option == "session") return "id";
    if (option == "attribute") return "attributes";
    std::string keyword(option);
    std::ranges::replace(keyword, '-', '_');
    return keyword;
}

std::string text_of(const py::object& given, const std::string& name) {
    Py_ssize_t size = 0;
    const char* const text = PyUnicode_Check(given.ptr()) != 0 ? PyUnicode_AsUTF8AndSize(given.ptr(), &size) : nullptr;
    const std::string_view whole(text == nullptr ? "" : text, static_cast<std::size_t>(size));
    if (text != nullptr && whole.find('\0') == std::string_view::npos) return std::string(whole);
    PyErr_Clear();
    throw InvalidInput(name + " is " + std::string(py::repr(given)) + ", must be a text without a zero byte");
}

std::uint64_t whole_number(const py::object& given, const std::string& name, std::uint64_t largest) {
    if (PyIndex_Check(given.ptr()) != 0) {
        const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
        if (!number) throw py::error_already_set();
        const std::uint64_t value = PyLong_AsUnsignedLongLong(number.ptr());
        if (PyErr_Occurred() == nullptr && value <= largest) return value;
        PyErr_Clear();
    }
    throw InvalidInput(name + " is " + std::string(py::repr(given)) + ", must be a whole number from 0 to " +
                       std::to_string(largest));
}

std::optional<std::uint64_t> index_of(const py::object& given) {
    if (given.is_none()) return std::nullopt;
    return whole_number(given, "index", std::numeric_limits<std::uint64_t>::max());
}

}  // namespace meniscus::python
