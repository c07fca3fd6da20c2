#include "threads/waiting.hpp"

#include <pybind11/pybind11.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <utility>

#include "threads/interpreter_lock.hpp"
#include "threads/worker.hpp"

namespace meniscus::python {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// Between two looks at signals: short to a person at Ctrl-C.
constexpr milliseconds piece_between_signals{50};

/// The main thread's worker, while it is not used. It is kept, for the libraries below have memory for each thread that
/// computes, which a new one would have to take again for every frame. Never destroyed: a forked process would wait for
/// a thread that is not there.
std::unique_ptr<Worker>& idle_worker() {
    static auto* const worker = new std::unique_ptr<Worker>;
    return *worker;
}

}  // namespace

bool is_main_thread() {
    return syscall(SYS_gettid) == getpid();
}

void wait_for(const std::function<void()>& work, const std::function<void()>& stop) {
    if (!is_main_thread()) return without_lock(work);
    // A signal's handler may wait, too, while this does.
    std::unique_ptr<Worker> worker = std::move(idle_worker());
    if (!worker) worker = std::make_unique<Worker>();
    worker->begin(work);
    std::exception_ptr error;
    for (bool is_done = false; !is_done;) {
        without_lock([&] { is_done = worker->wait(piece_between_signals); });
        if (is_done) error = worker->error();
        if (is_done || PyErr_CheckSignals() == 0) continue;
        error = std::make_exception_ptr(pybind11::error_already_set());
        stop();
        without_lock([&] {
            while (!worker->wait(piece_between_signals)) continue;
        });
        worker->error();  // unused: the interrupt is what is thrown
        is_done = true;
    }
    idle_worker() = std::move(worker);
    if (error) std::rethrow_exception(error);
}

bool wait_in_pieces(const std::function<bool(milliseconds piece)>& wait, std::optional<milliseconds> limit) {
    const auto start = Clock::now();
    for (;;) {
        const auto left =
            limit ? *limit - std::chrono::duration_cast<milliseconds>(Clock::now() - start) : piece_between_signals;
        bool is_done = false;
        without_lock([&] { is_done = wait(std::clamp(left, milliseconds(0), piece_between_signals)); });
        if (is_done) return true;
        if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
        if (limit && left <= piece_between_signals) return false;
    }
}

}  // namespace meniscus::python
