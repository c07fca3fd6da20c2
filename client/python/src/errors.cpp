#include "meniscus/client/errors.hpp"

#include <initializer_list>
#include <utility>

#include "bindings.hpp"
#include "meniscus/error.hpp"
#include "meniscus/names.hpp"
#include "python_words.hpp"
#include "text_out.hpp"
#include "threads/process.hpp"

namespace py = pybind11;

// Before 2.8 a translator sees the exceptions of other modules, too: those that may be theirs are left alone.
#define MENISCUS_LOCAL_TRANSLATORS (PYBIND11_VERSION_MAJOR > 2 || PYBIND11_VERSION_MINOR >= 8)

namespace meniscus::python {
namespace {

using Attributes = std::initializer_list<std::pair<const char*, py::object>>;

/// An error of meniscus/errors.py. Runs nothing that is written in Python: there, at the end of the interpreter, a
/// daemon thread that waits for the lock is unwound by Python, and no handler of C++ may meet that unwinding while it
/// handles an exception, as translators do.
void raise(const char* name, const std::exception& error, Attributes attributes = {}) {
    const py::object type = py::module_::import("meniscus.errors").attr(name);
    const py::object raised = type.attr("__new__")(type, text_out(in_python_words(error.what())));
    for (const auto& [attribute, value] : attributes) raised.attr(attribute) = value;
    PyErr_SetObject(type.ptr(), raised.ptr());
}

void translate(std::exception_ptr thrown) {
    try {
        std::rethrow_exception(std::move(thrown));
    } catch (const InvalidInput& error) {
        raise("InvalidInput", error);
    } catch (const LimitExceeded& error) {
        raise("LimitExceeded", error);
    } catch (const DeviceError& error) {
        raise("DeviceError", error, {{"device", py::int_(error.device())}});
    } catch (const client::ServerError& error) {
        raise("ServerError", error, {{"code", text_out(name_of(error.code()))}, {"status", text_out(error.status())}});
    } catch (const ForkedError& error) {
        raise("ForkedError", error);
    } catch (const NotBuilt& error) {
        raise("Error", error);
    } catch (const py::builtin_exception&) {
        throw;  // pybind11's own
    }
#if MENISCUS_LOCAL_TRANSLATORS
    catch (const std::runtime_error& error) {
        raise("Error", error);  // a full disk, no more threads
    }
#endif
}

}  // namespace

void bind_errors(py::module_& /*module*/) {
#if MENISCUS_LOCAL_TRANSLATORS
    py::register_local_exception_translator(&translate);
#else
    py::register_exception_translator(&translate);
#endif
}

}  // namespace meniscus::python
