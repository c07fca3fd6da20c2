// The CPU backend's parallel loop: oneTBB, or std::thread where a tool cannot see through oneTBB.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <thread>

#include "meniscus/error.hpp"
#include "meniscus/stop_flag.hpp"

#ifdef MENISCUS_STD_THREADS
#include <atomic>
#include <exception>
#include <mutex>
#include <vector>
#else
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>
#endif

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace meniscus::cpu {

/// Subnormal numbers are kept: flushing them would make results depend on the host program's floating-point state.
class ExactFloats {
public:
    ExactFloats() : before_(state()) { set_state(before_ & ~inexact); }
    ~ExactFloats() { set_state(before_); }
    ExactFloats(const ExactFloats&) = delete;
    ExactFloats& operator=(const ExactFloats&) = delete;

private:
    // inexact: flush-to-zero, denormals-are-zero, rounding other than to nearest.
#if defined(__SSE2__)
    static constexpr unsigned inexact = 0xE040;
    static unsigned state() {
        return _mm_getcsr();
    }
    static void set_state(unsigned bits) {
        _mm_setcsr(bits);
    }
#elif defined(__aarch64__)
    static constexpr unsigned inexact = 0x1C0'0000;
    static unsigned state() {
        return static_cast<unsigned>(__builtin_aarch64_get_fpcr());
    }
    static void set_state(unsigned bits) {
        __builtin_aarch64_set_fpcr(bits);
    }
#else
    static constexpr unsigned inexact = 0;
    static unsigned state() {
        return 0;
    }
    static void set_state(unsigned) {}
#endif

    unsigned before_;
};

class Workers {
public:
    /// threads: 0 for one per processor. stop: outlives the workers; none: nothing stops them.
    explicit Workers(unsigned threads, const StopFlag* stop = nullptr)
        : count_(threads != 0 ? threads : std::max(1U, std::thread::hardware_concurrency())),
          stop_(stop)
#ifndef MENISCUS_STD_THREADS
          ,
          more_than_processors_(
              count_ > std::thread::hardware_concurrency()
                  ? std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, count_)
                  : nullptr),
          arena_(static_cast<int>(count_))
#endif
    {
    }

    unsigned count() const {
        return count_;
    }

    /// Throws Stopped once a stop is asked for. Loops ask at least every 0.1 s.
    void go_on() const {
        if (stop_ != nullptr && stop_->is_raised()) throw Stopped();
    }

    /// Calls body(begin, end, worker) for pieces of [0, n) of about `grain`; worker < count() names the thread, so that
    /// a body can use scratch memory of its own. Asks go_on() before each piece.
    template <class Body>
    void for_ranges(std::size_t n, std::size_t grain, const Body& body) {
        if (n == 0) return;
        if (count_ == 1 || n <= grain) {
            const ExactFloats exact;
            for (std::size_t begin = 0; begin < n; begin += grain) {
                go_on();
                body(begin, std::min(n, begin + grain), 0U);
            }
            return;
        }
        run(n, grain, body);
    }

    /// Sorts in place; `before` must be a strict order that leaves no two different elements equal.
    template <class T, class Before>
    void sort(T* begin, T* end, const Before& before) {
        if (stop_ != nullptr)
            sort_to_the_end(begin, end, [this, &before](const T& a, const T& b) {
                go_on();
                return before(a, b);
            });
        else
            sort_to_the_end(begin, end, before);
    }

private:
    template <class T, class Before>
    void sort_to_the_end(T* begin, T* end, const Before& before) {
#ifdef MENISCUS_STD_THREADS
        std::sort(begin, end, before);
#else
        if (count_ == 1)
            std::sort(begin, end, before);
        else
            arena_.execute([&] { tbb::parallel_sort(begin, end, before); });
#endif
    }

#ifdef MENISCUS_STD_THREADS
    template <class Body>
    void run(std::size_t n, std::size_t grain, const Body& body) {
        std::atomic<std::size_t> next{0};
        std::exception_ptr failure;
        std::mutex mutex;
        const auto work = [&](unsigned worker) {
            const ExactFloats exact;
            try {
                for (;;) {
                    const std::size_t begin = next.fetch_add(grain);
                    if (begin >= n) return;
                    go_on();
                    body(begin, std::min(n, begin + grain), worker);
                }
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!failure) failure = std::current_exception();
                next = n;
            }
        };
        std::vector<std::jthread> threads;
        for (unsigned i = 1; i < count_; ++i) threads.emplace_back(work, i);
        work(0);
        threads.clear();
        if (failure) std::rethrow_exception(failure);
    }
#else
    template <class Body>
    void run(std::size_t n, std::size_t grain, const Body& body) {
        arena_.execute([&] {
            tbb::parallel_for(tbb::blocked_range<std::size_t>(0, (n + grain - 1) / grain, 1),
                              [&](const tbb::blocked_range<std::size_t>& pieces) {
                                  const ExactFloats exact;
                                  const auto worker =
                                      static_cast<unsigned>(tbb::this_task_arena::current_thread_index());
                                  for (std::size_t piece = pieces.begin(); piece != pieces.end(); ++piece) {
                                      go_on();
                                      body(piece * grain, std::min(n, (piece + 1) * grain), worker);
                                  }
                              });
        });
    }
#endif

    unsigned count_;
    const StopFlag* stop_;
#ifndef MENISCUS_STD_THREADS
    std::unique_ptr<tbb::global_control> more_than_processors_;
    tbb::task_arena arena_;
#endif
};

}  // namespace meniscus::cpu
