// A CUDA stream and events in it, destroyed with their owner.
#pragma once

#include <chrono>
#include <utility>

#include "engine/cuda/errors.hpp"

namespace meniscus::cuda {

class Event {
public:
    Event() : Event(cudaEventDefault) {}
    ~Event() { cudaEventDestroy(event_); }
    Event(const Event&) = delete;
    Event& operator=(const Event&) = delete;

    /// captured: whether the stream is being captured into a graph, which is then to record the event each time it
    /// runs.
    void record(cudaStream_t stream, bool captured = false) {
        check(captured ? cudaEventRecordWithFlags(event_, stream, cudaEventRecordExternal)
                       : cudaEventRecord(event_, stream),
              "cudaEventRecord");
    }
    /// Makes the work that is put on the stream from now on wait for the event.
    void hold_up(cudaStream_t stream) const { check(cudaStreamWaitEvent(stream, event_, 0), "cudaStreamWaitEvent"); }
    /// Seconds between two events that have happened. 0 where CUDA gives none: a missing time is no reason to fail a
    /// frame.
    double seconds_since(const Event& start) const {
        float milliseconds = 0.0F;
        if (cudaEventElapsedTime(&milliseconds, start.event_, event_) != cudaSuccess) {
            cudaGetLastError();  // else the next call in this thread would be taken for the one that failed
            return 0.0;
        }
        return static_cast<double>(milliseconds) * 1e-3;
    }

protected:
    explicit Event(unsigned flags) { check(cudaEventCreateWithFlags(&event_, flags), "cudaEventCreateWithFlags"); }

    cudaEvent_t event_ = nullptr;
};

/// A thread that waits for it asks for a while, since to be woken takes tens of microseconds; then it sleeps rather
/// than to keep a core busy, which others need for encoding. The GPU interrupts the host for it, waited for or not, so
/// that events which measure alone are none.
class AwaitedEvent : public Event {
public:
    AwaitedEvent() : Event(cudaEventBlockingSync) {}
    void wait() {
        const auto sleeps_at = std::chrono::steady_clock::now() + std::chrono::microseconds(100);
        do {
            const cudaError_t status = cudaEventQuery(event_);
            if (status == cudaSuccess) return;
            if (status != cudaErrorNotReady) check(status, "cudaEventQuery");
            cudaGetLastError();  // else the next call in this thread would be taken for one that failed
        } while (std::chrono::steady_clock::now() < sleeps_at);
        check(cudaEventSynchronize(event_), "cudaEventSynchronize");
    }
};

class Stream {
public:
    Stream() { check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "cudaStreamCreateWithFlags"); }
    ~Stream() {
        // Work that still runs may use memory that is freed next.
        cudaStreamSynchronize(stream_);
        cudaStreamDestroy(stream_);
    }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;

    cudaStream_t get() const { return stream_; }
    /// Waits for all that is on the stream; the thread sleeps meanwhile.
    void synchronize() {
        all_.record(stream_);
        all_.wait();
    }

    /// The same after a failure: errors of the wait are dropped, since the first one counts.
    void settle() noexcept {
        cudaStreamSynchronize(stream_);
        cudaGetLastError();
    }

private:
    cudaStream_t stream_ = nullptr;
    AwaitedEvent all_;
};

}  // namespace meniscus::cuda
