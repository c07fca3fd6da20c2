// The common part of streams, watchers and readers of recordings: frames that come one after the other.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "meniscus/client/next.hpp"
#include "meniscus/error.hpp"
#include "sessions/particle_frame.hpp"
#include "sessions/waiting_delete.hpp"
#include "surfaces/frame.hpp"
#include "threads/interpreter_lock.hpp"
#include "threads/process.hpp"
#include "threads/waiting.hpp"

namespace meniscus::python {

/// None: no limit. Throws InvalidInput for what is no number.
inline std::optional<std::chrono::milliseconds> limit_of(std::optional<double> seconds) {
    if (!seconds) return std::nullopt;
    if (!(*seconds >= 0.0))  // also a NaN
        throw InvalidInput("timeout is " + std::to_string(*seconds) +
                           ", must be 0 or more seconds, or None for no limit");
    constexpr double ten_years = 3.2e8;
    if (*seconds > ten_years) return std::nullopt;
    // Rounded up: what is more than nothing is a wait.
    return std::chrono::milliseconds(std::llround(std::ceil(*seconds * 1000.0)));
}

/// Source: a Stream, Watcher, ParticleWatcher or RecordingReader. Several threads may use one.
template <class Source>
class FrameSource {
public:
    explicit FrameSource(Source&& source) : source_(std::move(source)) {}

    /// The frame or None, and whether there are no more.
    pybind11::tuple next(std::optional<double> seconds) {
        require_own_process();
        if (kept_) return to_tuple(std::move(*std::exchange(kept_, std::nullopt)));
        Found found;
        wait_in_pieces(
            [&](std::chrono::milliseconds piece) {
                const std::unique_lock turn(turn_, piece);
                if (!turn) return false;
                found = source_.next(piece);
                return found.frame.has_value() || found.ended;
            },
            limit_of(seconds));
        // Python would raise the interrupt before the caller has the frame.
        if ((found.frame || found.ended) && PyErr_CheckSignals() != 0) {
            kept_ = std::move(found);
            throw pybind11::error_already_set();
        }
        return to_tuple(std::move(found));
    }

    /// From any thread. Does nothing in a forked process: what is there is its parent's.
    void cancel() {
        if (is_forked()) return;
        without_lock([this] { source_.cancel(); });
    }

protected:
    Source source_;

private:
    using Found = decltype(std::declval<Source&>().next(std::chrono::milliseconds()));

    static pybind11::tuple to_tuple(Found found) {
        pybind11::object frame = pybind11::none();
        if (found.frame) frame = pybind11::cast(handle_of(std::move(*found.frame)));
        return pybind11::make_tuple(frame, found.ended);
    }

    std::timed_mutex turn_;
    std::optional<Found> kept_;  ///< a result that Ctrl-C kept from its caller; under the interpreter's lock
};

/// The class of a source, with what all have.
template <class T>
pybind11::class_<T, Held<T>> bind_source(pybind11::module_& module, const char* name) {
    return pybind11::class_<T, Held<T>>(module, name).def("next", &T::next).def("cancel", &T::cancel);
}

}  // namespace meniscus::python
