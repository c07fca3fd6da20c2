// A Python function that is called at attempts to go on after a connection broke.
#pragma once

#include <pybind11/pybind11.h>

#include "meniscus/client/reconnect_event.hpp"

namespace meniscus::python {

/// Calls function(attempt, connected, reason, seconds left) in the library's thread, with the interpreter's lock. What
/// it raises goes to sys.unraisablehook. None makes no handler. Throws InvalidInput for what cannot be called.
client::ReconnectHandler reconnect_handler(const pybind11::object& function);

/// Whether this thread is within such a call.
bool is_in_handler() noexcept;

}  // namespace meniscus::python
