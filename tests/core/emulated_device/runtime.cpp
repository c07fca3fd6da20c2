// The runtime of the device in software: work is done when the host waits for it, and no sooner.
#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <vector>

#include "cuda_runtime.h"
#include "events_and_graphs.hpp"
#include "host_copies.hpp"

struct EmulatedGraph {
    std::vector<std::function<void()>> work;
    int owners = 1;
};
struct EmulatedStream {
    std::deque<std::function<void()>> waiting;
    std::size_t submitted = 0;
    std::size_t done = 0;
    EmulatedGraph* capturing = nullptr;
};
struct EmulatedEvent {
    EmulatedStream* stream = nullptr;  ///< none before it is recorded
    std::size_t after = 0;             ///< amount of the stream's work before it
};

namespace {
/// Whether this thread captures a graph, which forbids it to wait or to allocate.
thread_local bool captures = false;

std::mutex device;  // its threads are one set of fibers: it works for one thread of the host at a time

/// Sizes of pieces of device memory, and of pinned host memory, by their begin.
struct Piece {
    std::size_t bytes;
    cudaMemoryType type;
};
std::mutex pieces_mutex;
std::map<const std::byte*, Piece> pieces;

void add_piece(void* memory, std::size_t bytes, cudaMemoryType type) {
    const std::lock_guard lock(pieces_mutex);
    pieces[static_cast<const std::byte*>(memory)] = {bytes, type};
}
bool remove_piece(void* memory) {
    const std::lock_guard lock(pieces_mutex);
    return pieces.erase(static_cast<const std::byte*>(memory)) != 0;
}
/// Whether some bytes of this host memory are pinned and others are not.
bool is_partly_pinned(const void* memory, std::size_t bytes) {
    const auto* const begin = static_cast<const std::byte*>(memory);
    const std::byte* const end = begin + bytes;
    std::size_t pinned = 0;
    const std::lock_guard lock(pieces_mutex);
    for (const auto& [at, piece] : pieces)
        if (piece.type == cudaMemoryTypeHost && at < end && begin < at + piece.bytes)
            pinned += static_cast<std::size_t>(std::min(end, at + piece.bytes) - std::max(begin, at));
    return pinned != 0 && pinned != bytes;
}
/// Allocates no byte more, so that the address sanitizer sees accesses beside it.
cudaError_t allocate(void** memory, std::size_t bytes) {
    if (captures) return cudaErrorStreamCaptureUnsupported;
    return posix_memalign(memory, 256, bytes) == 0 ? cudaSuccess : cudaErrorMemoryAllocation;
}

cudaError_t release(EmulatedGraph* graph) {
    if (--graph->owners == 0) delete graph;
    return cudaSuccess;
}

void enqueue(EmulatedStream& stream, const std::function<void()>& work) {
    const std::lock_guard lock(device);
    stream.waiting.push_back(work);
    ++stream.submitted;
}

/// Works off the stream's first pieces of work, this many since its begin.
void run_until(EmulatedStream& stream, std::size_t count) {
    while (stream.done < count) {
        stream.waiting.front()();
        stream.waiting.pop_front();
        ++stream.done;
    }
}
}  // namespace

emulated_device::KernelRunner* emulated_device::runner = nullptr;
std::function<cudaError_t()> emulated_device::before_copy_to_host;
std::set<const void*> emulated_device::most_shared;
std::size_t emulated_device::graph_launches = 0;
cudaError_t emulated_device::instantiate_status = cudaSuccess;
cudaError_t emulated_device::elapsed_time_status = cudaSuccess;
cudaError_t emulated_device::register_status = cudaSuccess;
cudaError_t emulated_device::unregister_status = cudaSuccess;
std::function<cudaError_t(const void*, const void*, std::size_t, cudaMemcpyKind)> emulated_device::on_copy;

void emulated_device::submit(cudaStream_t stream, const std::function<void()>& work) {
    if (stream->capturing != nullptr)
        stream->capturing->work.push_back(work);
    else
        enqueue(*stream, work);
}

const char* cudaGetErrorString(cudaError_t status) {
    switch (status) {
        case cudaSuccess:
            return "no error";
        case cudaErrorMemoryAllocation:
            return "out of memory";
        case cudaErrorLaunchFailure:
            return "launch failure";
        case cudaErrorInvalidValue:
            return "invalid argument";
        case cudaErrorHostMemoryNotRegistered:
            return "pointer does not correspond to a registered memory region";
        case cudaErrorInvalidConfiguration:
            return "invalid configuration argument";
        case cudaErrorNotReady:
            return "device not ready";
        case cudaErrorCooperativeLaunchTooLarge:
            return "too many blocks in cooperative launch";
        case cudaErrorStreamCaptureUnsupported:
            return "operation not permitted when stream is capturing";
    }
    return "unknown error";
}
cudaError_t cudaFuncSetAttribute(const void* kernel, cudaFuncAttribute, int value) {
    if (value == cudaSharedmemCarveoutMaxShared) emulated_device::most_shared.insert(kernel);
    return cudaSuccess;
}
cudaError_t cudaGetLastError() {
    return cudaSuccess;
}
cudaError_t cudaGetDevice(int* device) {
    return *device = 0, cudaSuccess;
}
cudaError_t cudaSetDevice(int) {
    return cudaSuccess;
}
cudaError_t cudaGetDriverEntryPointByVersion(const char*, void**, unsigned, unsigned long long,
                                             cudaDriverEntryPointQueryResult*) {
    return cudaSuccess;
}
cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr, int) {
    const unsigned processors =
        emulated_device::runner != nullptr ? emulated_device::runner->processors : emulated_device::processors;
    return *value = static_cast<int>(processors), cudaSuccess;
}

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned) {
    return *stream = new EmulatedStream, cudaSuccess;
}
cudaError_t cudaStreamSynchronize(cudaStream_t stream) {
    if (captures) return cudaErrorStreamCaptureUnsupported;
    const std::lock_guard lock(device);
    run_until(*stream, stream->submitted);
    return cudaSuccess;
}
cudaError_t cudaStreamWaitEvent(cudaStream_t stream, cudaEvent_t event, unsigned) {
    // While this stream's work is done the device is locked already.
    if (event->stream != nullptr)
        emulated_device::submit(stream, [other = event->stream, after = event->after] { run_until(*other, after); });
    return cudaSuccess;
}
cudaError_t cudaStreamDestroy(cudaStream_t stream) {
    cudaStreamSynchronize(stream);
    delete stream;
    return cudaSuccess;
}
cudaError_t cudaStreamBeginCapture(cudaStream_t stream, cudaStreamCaptureMode) {
    captures = true;
    return stream->capturing = new EmulatedGraph, cudaSuccess;
}
cudaError_t cudaStreamEndCapture(cudaStream_t stream, cudaGraph_t* graph) {
    *graph = stream->capturing;
    stream->capturing = nullptr;
    captures = false;
    return cudaSuccess;
}
cudaError_t cudaGraphInstantiate(cudaGraphExec_t* executable, cudaGraph_t graph, unsigned long long) {
    if (emulated_device::instantiate_status != cudaSuccess) return emulated_device::instantiate_status;
    ++graph->owners;
    return *executable = graph, cudaSuccess;
}
cudaError_t cudaGraphLaunch(cudaGraphExec_t graph, cudaStream_t stream) {
    ++emulated_device::graph_launches;
    for (const auto& work : graph->work) enqueue(*stream, work);
    return cudaSuccess;
}
cudaError_t cudaGraphDestroy(cudaGraph_t graph) {
    return release(graph);
}
cudaError_t cudaGraphExecDestroy(cudaGraphExec_t graph) {
    return release(graph);
}

cudaError_t cudaEventCreateWithFlags(cudaEvent_t* event, unsigned) {
    return *event = new EmulatedEvent, cudaSuccess;
}
cudaError_t cudaEventDestroy(cudaEvent_t event) {
    delete event;
    return cudaSuccess;
}
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream) {
    const std::lock_guard lock(device);
    *event = {stream, stream->submitted};
    return cudaSuccess;
}
cudaError_t cudaEventRecordWithFlags(cudaEvent_t, cudaStream_t, unsigned) {
    return cudaSuccess;
}
cudaError_t cudaEventSynchronize(cudaEvent_t event) {
    if (captures) return cudaErrorStreamCaptureUnsupported;
    const std::lock_guard lock(device);
    if (event->stream != nullptr) run_until(*event->stream, event->after);
    return cudaSuccess;
}
cudaError_t cudaEventQuery(cudaEvent_t event) {
    if (captures) return cudaErrorStreamCaptureUnsupported;
    const std::lock_guard lock(device);
    return event->stream == nullptr || event->stream->done >= event->after ? cudaSuccess : cudaErrorNotReady;
}
cudaError_t cudaEventElapsedTime(float* milliseconds, cudaEvent_t, cudaEvent_t) {
    // The number that a failing call has given must not be used.
    *milliseconds = emulated_device::elapsed_time_status == cudaSuccess ? 0.0F : 1e9F;
    return emulated_device::elapsed_time_status;
}

cudaError_t cudaMemPoolCreate(cudaMemPool_t*, const cudaMemPoolProps*) {
    return cudaSuccess;
}
cudaError_t cudaMemPoolDestroy(cudaMemPool_t) {
    return cudaSuccess;
}
cudaError_t cudaMallocFromPoolAsync(void** memory, std::size_t bytes, cudaMemPool_t, cudaStream_t) {
    const cudaError_t status = allocate(memory, bytes);
    if (status == cudaSuccess) add_piece(*memory, bytes, cudaMemoryTypeDevice);
    return status;
}
cudaError_t cudaFreeAsync(void* memory, cudaStream_t stream) {
    if (captures) return cudaErrorStreamCaptureUnsupported;
    remove_piece(memory);
    emulated_device::submit(stream, [=] {
        std::memset(memory, 0xDD, malloc_usable_size(memory));  // for code that still reads it
        std::free(memory);
    });
    return cudaSuccess;
}
cudaError_t cudaPointerGetAttributes(cudaPointerAttributes* attributes, const void* memory) {
    const auto* const at = static_cast<const std::byte*>(memory);
    const std::lock_guard lock(pieces_mutex);
    auto piece = pieces.upper_bound(at);
    const bool is_inside = piece != pieces.begin() && at < std::prev(piece)->first + std::prev(piece)->second.bytes;
    *attributes = {is_inside ? std::prev(piece)->second.type : cudaMemoryTypeUnregistered, 0};
    return cudaSuccess;
}
cudaError_t cudaMallocHost(void** memory, std::size_t bytes) {
    const cudaError_t status = allocate(memory, bytes);
    if (status == cudaSuccess) add_piece(*memory, bytes, cudaMemoryTypeHost);
    return status;
}
cudaError_t cudaHostRegister(void* memory, std::size_t bytes, unsigned) {
    if (emulated_device::register_status == cudaSuccess) add_piece(memory, bytes, cudaMemoryTypeHost);
    return emulated_device::register_status;
}
cudaError_t cudaHostUnregister(void* memory) {
    if (emulated_device::unregister_status != cudaSuccess) return emulated_device::unregister_status;
    return remove_piece(memory) ? cudaSuccess : cudaErrorHostMemoryNotRegistered;
}
cudaError_t cudaHostGetDevicePointer(void** mapped, void* memory, unsigned) {
    return *mapped = memory, cudaSuccess;
}
cudaError_t cudaFreeHost(void* memory) {
    remove_piece(memory);
    return std::free(memory), cudaSuccess;
}
cudaError_t cudaMemsetAsync(void* memory, int value, std::size_t bytes, cudaStream_t stream) {
    emulated_device::submit(stream, [=] { std::memset(memory, value, bytes); });
    return cudaSuccess;
}
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind, cudaStream_t stream) {
    if (kind == cudaMemcpyDeviceToHost && emulated_device::before_copy_to_host)
        if (const cudaError_t status = emulated_device::before_copy_to_host(); status != cudaSuccess) return status;
    if (emulated_device::on_copy)
        if (const cudaError_t status = emulated_device::on_copy(to, from, bytes, kind); status != cudaSuccess)
            return status;
    // As CUDA does.
    const bool is_refused = (kind == cudaMemcpyHostToDevice && is_partly_pinned(from, bytes)) ||
                            (kind == cudaMemcpyDeviceToHost && is_partly_pinned(to, bytes));
    if (is_refused) return cudaErrorInvalidValue;
    emulated_device::submit(stream, [=] { std::memcpy(to, from, bytes); });
    return cudaSuccess;
}
