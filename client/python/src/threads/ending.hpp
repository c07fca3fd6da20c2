// The end of the interpreter: computations of daemon threads end before the libraries under them do.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "meniscus/stop_flag.hpp"

namespace meniscus::python {

/// A computation under way, for as long as this lives. At the end of the interpreter it is stopped and waited for.
class Computation {
public:
    /// With the interpreter's lock. stop: ends it early; may be none.
    explicit Computation(std::shared_ptr<StopFlag> stop = nullptr);
    ~Computation();
    Computation(const Computation&) = delete;
    Computation& operator=(const Computation&) = delete;

private:
    std::shared_ptr<StopFlag> stop_;
};

/// Begins the end, once main modules and other threads are done.
void bind_ending(pybind11::module_& module);

/// With the interpreter's lock: a daemon thread at the end of the interpreter gives it back and rests until the process
/// ends; others return.
void rest_at_end();

}  // namespace meniscus::python
