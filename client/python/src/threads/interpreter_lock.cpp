#include "threads/interpreter_lock.hpp"

#include <unistd.h>

#include <exception>

namespace meniscus::python {
namespace {

/// Python ends threads that ask for the lock of an interpreter that is being finalized by pthread_exit(), whose
/// unwinding would destroy Python objects without the lock, and abort in noexcept functions.
template <class Take>
auto taken(const Take& take) {
    try {
        return take();
    } catch (...) {  // the unwinding: Python's functions throw nothing, and a reference to abi::__forced_unwind is null
        for (;;) pause();
    }
}

}  // namespace

void ReleasedLock::take_back() {
    taken([this] { PyEval_RestoreThread(state_); });
}

void without_lock(const std::function<void()>& work) {
    std::exception_ptr error;
    ReleasedLock released;
    try {
        work();
    } catch (...) {
        error = std::current_exception();
    }
    released.take_back();
    if (error) std::rethrow_exception(error);
}

void with_lock(const std::function<void()>& work) {
    const PyGILState_STATE state = taken([] { return PyGILState_Ensure(); });
    std::exception_ptr error;
    try {
        work();
    } catch (...) {
        error = std::current_exception();
    }
    PyGILState_Release(state);
    if (error) std::rethrow_exception(error);
}

}  // namespace meniscus::python
