// A Python function that is called at attempts to go on after a connection broke.
#pragma once

#include <pybind11/pybind11.h>

#include "meniscus/client/reconnect_event.hpp"
#include "text_options/option_reader.hpp"
#include "values/keywords.hpp"

namespace meniscus::python {

/// Calls function(attempt, connected, reason, seconds left) in the library's thread, with the interpreter's lock. What
/// it raises goes to sys.unraisablehook. None makes no handler. Throws InvalidInput for what cannot be called.
client::ReconnectHandler reconnect_handler(const pybind11::object& function);

/// The request that read(reader) makes of the options, with the handler. Throws InvalidInput for an option that is
/// wrong.
template <class Read>
auto request_of(const text_options::Options& options, const pybind11::object& on_reconnect, const Read& read) {
    auto reader = reader_of(options);
    auto request = read(reader);
    reader.finish();
    request.on_reconnect = reconnect_handler(on_reconnect);
    return request;
}

/// Whether this thread is within such a call.
bool is_in_handler() noexcept;

}  // namespace meniscus::python
