#include "sessions/reconnect_handler.hpp"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>

#include "bindings.hpp"
#include "meniscus/error.hpp"
#include "threads/interpreter_lock.hpp"
#include "threads/process.hpp"
#include "threads/waiting.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

/// The calls that run. None begins once the interpreter ends: a thread that asks for the lock of an interpreter that
/// has gone would never return, and its stream would wait for it.
class RunningCalls {
public:
    bool begin() {
        const std::lock_guard lock(mutex_);
        if (!may_begin_) return false;
        ++running_;
        return true;
    }
    void end() {
        const std::lock_guard lock(mutex_);
        --running_;
        changed_.notify_all();
    }
    /// No more of them. Returns whether none runs, at the latest after the limit.
    bool finish(std::chrono::milliseconds limit) {
        std::unique_lock lock(mutex_);
        may_begin_ = false;
        return changed_.wait_for(lock, limit, [this] { return running_ == 0; });
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    int running_ = 0;
    bool may_begin_ = true;
};

RunningCalls& running_calls() {
    static auto* const calls = new RunningCalls;  // never destroyed: threads of the library outlive main()
    return *calls;
}

thread_local bool in_handler = false;

/// Calls the function, with the interpreter's lock.
void call_function(PyObject* function, const client::ReconnectEvent& event) {
    const double left = std::chrono::duration<double>(event.left).count();
    PyObject* const reason =
        PyUnicode_DecodeUTF8(event.reason.data(), static_cast<Py_ssize_t>(event.reason.size()), "backslashreplace");
    PyObject* result = nullptr;
    if (reason != nullptr)
        result =
            PyObject_CallFunction(function, "IOOd", event.attempt, event.connected ? Py_True : Py_False, reason, left);
    if (result == nullptr) PyErr_WriteUnraisable(function);
    Py_XDECREF(result);
    Py_XDECREF(reason);
}

/// Lets go of the function with the lock, in whatever thread; at the interpreter's end it stays.
void release_function(PyObject* function) {
    if (!running_calls().begin()) return;
    with_lock([function] { Py_DECREF(function); });
    running_calls().end();
}

}  // namespace

client::ReconnectHandler reconnect_handler(const py::object& function) {
    if (function.is_none()) return {};
    if (PyCallable_Check(function.ptr()) == 0)
        throw InvalidInput("on_reconnect is " + std::string(py::repr(function)) +
                           ", must be a function of attempt, connected, reason and seconds left");
    return [kept = std::shared_ptr<PyObject>(function.inc_ref().ptr(), release_function)](
               const client::ReconnectEvent& event) {
        if (!running_calls().begin()) return;
        in_handler = true;
        with_lock([&] { call_function(kept.get(), event); });
        in_handler = false;
        running_calls().end();
    };
}

bool is_in_handler() noexcept {
    return in_handler;
}

/// Once the interpreter ends, no handler is called any more, and those that run are waited for.
void bind_reconnect_handlers(py::module_& /*module*/) {
    py::module_::import("atexit").attr("register")(py::cpp_function([] {
        if (is_forked()) return;
        wait_in_pieces([](std::chrono::milliseconds piece) { return running_calls().finish(piece); }, std::nullopt);
    }));
}

}  // namespace meniscus::python
