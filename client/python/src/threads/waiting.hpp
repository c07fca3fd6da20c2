// Waiting without the interpreter's lock, such that Ctrl-C ends it.
#pragma once

#include <chrono>
#include <functional>
#include <optional>

namespace meniscus::python {

/// The thread to which Python gives signals.
bool is_main_thread();

/// Runs `work` without the interpreter's lock and returns when it is done; what it throws is thrown here. work touches
/// nothing of Python's. In the main thread, work runs in another thread, and signals are looked at meanwhile: after
/// Ctrl-C, `stop` is called, the end of work is waited for, whatever it comes to, and KeyboardInterrupt is thrown
/// (pybind11::error_already_set).
void wait_for(const std::function<void()>& work, const std::function<void()>& stop);

/// Calls `wait(piece)` without the lock again and again until it returns true or `limit` is over (none: no limit), and
/// looks at signals in between; with a limit of 0 once. Returns whether it was true. Throws KeyboardInterrupt where it
/// was not: nothing is lost then.
bool wait_in_pieces(const std::function<bool(std::chrono::milliseconds piece)>& wait,
                    std::optional<std::chrono::milliseconds> limit);

}  // namespace meniscus::python
