// A CUDA stream and events in it, destroyed with their owner.
#pragma once

#include <utility>

#include "engine/cuda/errors.hpp"

namespace meniscus::cuda {

class Stream {
public:
    Stream() { check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "cudaStreamCreateWithFlags"); }
    ~Stream() {
        // What still runs may use memory that is freed next.
        cudaStreamSynchronize(stream_);
        cudaStreamDestroy(stream_);
    }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;

    cudaStream_t get() const { return stream_; }
    void synchronize() { check(cudaStreamSynchronize(stream_), "cudaStreamSynchronize"); }

private:
    cudaStream_t stream_ = nullptr;
};

class Event {
public:
    Event() { check(cudaEventCreate(&event_), "cudaEventCreate"); }
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
    void wait() { check(cudaEventSynchronize(event_), "cudaEventSynchronize"); }
    /// What is put on the stream from now on waits for the event.
    void hold_up(cudaStream_t stream) const { check(cudaStreamWaitEvent(stream, event_, 0), "cudaStreamWaitEvent"); }
    /// Both must have happened.
    double seconds_since(const Event& start) const {
        float milliseconds = 0.0F;
        check(cudaEventElapsedTime(&milliseconds, start.event_, event_), "cudaEventElapsedTime");
        return static_cast<double>(milliseconds) * 1e-3;
    }

private:
    cudaEvent_t event_ = nullptr;
};

}  // namespace meniscus::cuda
