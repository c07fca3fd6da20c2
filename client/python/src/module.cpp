// The extension meniscus._meniscus: the C++ side of the package, as _meniscus.pyi has it.
#include <string>

#include "bindings.hpp"
#include "meniscus/reconstructor.hpp"
#include "threads/ending.hpp"

namespace {

PyObject* refuse_new(PyTypeObject* type, PyObject* /*arguments*/, PyObject* /*keywords*/) {
    PyErr_Format(PyExc_TypeError, "%s has no constructor: calls of the package meniscus return its objects",
                 type->tp_name);
    return nullptr;
}

/// X.__new__(X) would make an object with nothing behind it. The functions that return the objects make them otherwise.
void forbid_bare_objects(const pybind11::module_& module) {
    for (const auto& [name, member] : module.attr("__dict__").cast<pybind11::dict>())
        if (PyType_Check(member.ptr()) != 0) reinterpret_cast<PyTypeObject*>(member.ptr())->tp_new = refuse_new;
}

}  // namespace

PYBIND11_MODULE(_meniscus, module) {
    using namespace meniscus::python;
    module.attr("__version__") = std::string(meniscus::version());
    bind_errors(module);
    bind_ending(module);
    bind_files(module);
    bind_mesh(module);
    bind_device_mesh(module);
    bind_reconstructor(module);
    bind_parts(module);
    bind_service(module);
    forbid_bare_objects(module);
}
