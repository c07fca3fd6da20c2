// The interpreter's lock, given back for a while.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>

namespace meniscus::python {

/// Gives the lock back. In place of pybind11's gil_scoped_release, whose destructor takes it again: at the end of the
/// interpreter Python ends a daemon thread there, which must not happen in a destructor. Here such a thread rests until
/// the process ends.
class ReleasedLock {
public:
    ReleasedLock() : state_(PyEval_SaveThread()) {}
    ReleasedLock(const ReleasedLock&) = delete;
    ReleasedLock& operator=(const ReleasedLock&) = delete;

    /// To be called once, on every way out.
    void take_back();

private:
    PyThreadState* state_;
};

/// Runs `work`, which touches nothing of Python's, without the lock. What it throws is thrown here, with the lock.
void without_lock(const std::function<void()>& work);

/// Runs `work` in a thread that Python may not know, or that has given the lock back, with the lock. What it throws is
/// thrown here, without the lock. At the end of the interpreter the thread rests until the process ends.
void with_lock(const std::function<void()>& work);

}  // namespace meniscus::python
