// Texts of the library to Python.
#pragma once

#include <pybind11/pybind11.h>

#include <string_view>

namespace meniscus::python {

/// A text that may hold a path or a name of a file, which may be any bytes: those that are no UTF-8 become \xNN.
inline pybind11::str text_out(std::string_view text) {
    return pybind11::reinterpret_steal<pybind11::str>(
        PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "backslashreplace"));
}

}  // namespace meniscus::python
