// The class _meniscus.Parts: frames of a job's ranks.
#include <atomic>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "bindings.hpp"
#include "meniscus/error.hpp"
#include "mpi/rank_exchange.hpp"
#include "ranks/last_two.hpp"
#include "ranks/parts_job.hpp"
#include "text_options/option_reader.hpp"
#include "threads/ending.hpp"
#include "threads/interpreter_lock.hpp"
#include "threads/process.hpp"
#include "values/arrays_in.hpp"
#include "values/keywords.hpp"

namespace py = pybind11;

namespace meniscus::python {
namespace {

/// Of a call whose arguments may be wrong in one rank alone, for which the others must not wait: they are told by the
/// time.
struct FramePlace {
    std::uint64_t index;
    double time = std::numeric_limits<double>::quiet_NaN();
    std::exception_ptr wrong;

    FramePlace(const py::object& given_index, const py::object& given_time, std::uint64_t next) : index(next) {
        try {
            index = index_of(given_index).value_or(next);
            time = py::float_(given_time);
        } catch (...) {
            wrong = std::current_exception();
        }
    }
};

/// What `frame` gives. Errors of the package's are thrown as the library's, which all ranks then throw.
py::tuple arrays_of(const py::function& frame) {
    try {
        return frame();
    } catch (const py::error_already_set& raised) {
        if (raised.matches(py::module_::import("meniscus.errors").attr("InvalidInput")))
            throw InvalidInput(py::str(raised.value()).cast<std::string>());
        throw;
    }
}

/// One call at a time: of two threads that call, no rank could know which comes first in the others.
class OnlyCall {
public:
    explicit OnlyCall(std::atomic_flag& is_called) : is_called_(is_called) {
        if (is_called_.test_and_set())
            throw InvalidInput("these parts are in another call, which must return before the next one begins");
    }
    ~OnlyCall() { is_called_.clear(); }
    OnlyCall(const OnlyCall&) = delete;
    OnlyCall& operator=(const OnlyCall&) = delete;

private:
    std::atomic_flag& is_called_;
};

class RankParts {
public:
    RankParts(py::object exchange, const text_options::Options& options)
        : ranks_(std::move(exchange)), exchange_(ranks_) {
        const bool leads_node = ranks_.attr("leads_node").cast<bool>();
        without_lock([&] { job_.emplace(exchange_, leads_node, options); });
    }
    ~RankParts() {
        ReleasedLock released;
        job_.reset();
        released.take_back();
    }
    RankParts(const RankParts&) = delete;
    RankParts& operator=(const RankParts&) = delete;

    bool push(const py::function& frame, const py::object& index, const py::object& time) {
        require_own_process();
        const OnlyCall call(is_called_);
        const Computation pushing;
        const FramePlace place(index, time, job_->next_index());
        bool is_taken = false;
        try {
            without_lock([&] {
                is_taken = job_->push(
                    [&] {
                        OwnedFrame& owned = frames_.next();
                        with_lock([&] {
                            const py::tuple arrays = arrays_of(frame);
                            owned.take(given_frame(arrays[0], arrays[1], arrays[2]));
                        });
                        return HandedFrame(owned.frame(), true, true);
                    },
                    place.index, place.time);
            });
        } catch (...) {
            if (place.wrong) std::rethrow_exception(place.wrong);
            throw;
        }
        return is_taken;
    }
    void finish() {
        require_own_process();
        const OnlyCall call(is_called_);
        const Computation finishing;
        without_lock([this] { job_->finish(); });
    }
    std::string session_id() const { return job_->session_id(); }
    std::uint64_t dropped() const { return job_->dropped(); }

private:
    py::object ranks_;
    RankExchange exchange_;
    ranks::LastTwo<OwnedFrame> frames_;
    std::atomic_flag is_called_;
    std::optional<ranks::PartsJob> job_;  ///< goes first
};

}  // namespace

void bind_parts(py::module_& module) {
    py::class_<RankParts, std::shared_ptr<RankParts>>(module, "Parts")
        .def("push", &RankParts::push, py::arg("frame"), py::arg("index").none(true), py::arg("time"))
        .def("finish", &RankParts::finish)
        .def("session_id", &RankParts::session_id)
        .def("dropped", &RankParts::dropped);
    module.def(
        "make_parts",
        [](const py::object& exchange, const text_options::Options& options) {
            require_own_process();
            rest_at_end();
            return make_in_process<RankParts>(exchange, options);
        },
        py::arg("exchange"), py::arg("options"));
}

}  // namespace meniscus::python
