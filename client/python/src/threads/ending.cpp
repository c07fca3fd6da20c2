#include "threads/ending.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>
#include <vector>

#include "threads/interpreter_lock.hpp"
#include "threads/process.hpp"
#include "threads/waiting.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

/// A reconstruction ends 0.2 s after its StopFlag; a file that is being written takes as long as it does. A daemon
/// thread is not worth more.
constexpr std::chrono::seconds most_patience{2};

struct Computations {
    std::mutex mutex;
    std::condition_variable changed;
    std::vector<StopFlag*> running;
    bool is_ending = false;
};

/// Never destroyed, for daemon threads outlive static objects.
Computations& computations() {
    static auto* const all = new Computations;
    return *all;
}

void end() {
    if (is_forked()) return;
    without_lock([] {
        Computations& all = computations();
        std::unique_lock lock(all.mutex);
        all.is_ending = true;
        for (StopFlag* stop : all.running)
            if (stop != nullptr) stop->raise();
        all.changed.wait_for(lock, most_patience, [&all] { return all.running.empty(); });
    });
}

}  // namespace

Computation::Computation(std::shared_ptr<StopFlag> stop) : stop_(std::move(stop)) {
    Computations& all = computations();
    const std::lock_guard lock(all.mutex);
    all.running.push_back(stop_.get());
    // A daemon thread whose turn has come since.
    if (all.is_ending && stop_ && !is_main_thread()) stop_->raise();
}

Computation::~Computation() {
    Computations& all = computations();
    const std::lock_guard lock(all.mutex);
    all.running.erase(std::find(all.running.begin(), all.running.end(), stop_.get()));
    all.changed.notify_all();
}

void rest_at_end() {
    {
        Computations& all = computations();
        const std::lock_guard lock(all.mutex);
        if (!all.is_ending || is_main_thread()) return;
    }
    PyEval_SaveThread();
    for (;;) pause();
}

void bind_ending(py::module_& /*module*/) {
    py::module_::import("atexit").attr("register")(py::cpp_function(&end));
}

}  // namespace meniscus::python
