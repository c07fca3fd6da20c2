// Destroying what waits in its destructor: for threads, for a server, or for a handler in Python.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <thread>

#include "sessions/reconnect_handler.hpp"
#include "threads/interpreter_lock.hpp"
#include "threads/process.hpp"

namespace meniscus::python {

/// Destroys without the interpreter's lock, which a handler may want. In a forked process it destroys nothing, since
/// the threads are not there.
struct WaitingDelete {
    template <class T>
    void operator()(T* content) const noexcept {
        if (is_forked()) return;
        if (is_in_handler()) {
            // It may be this very handler that is waited for.
            std::thread([content] { delete content; }).detach();
        } else if (PyGILState_Check() != 0) {
            ReleasedLock released;
            delete content;
            released.take_back();
        } else {
            delete content;
        }
    }
};

template <class T>
using Held = std::unique_ptr<T, WaitingDelete>;

template <class T>
Held<T> hold(T&& content) {
    return Held<T>(new T(std::forward<T>(content)));
}

}  // namespace meniscus::python
