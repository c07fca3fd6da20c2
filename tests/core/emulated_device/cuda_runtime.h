// A device in software, so that the CUDA backend's kernels run where there is no GPU: this stands in for CUDA's own
// header when they are compiled as C++. Every thread of a block is a fiber; fibers change where threads wait for each
// other, in an order of chance. Blocks begin in an order of chance, too: two at once, and all at once in a cooperative
// grid. Work waits in its stream until the host waits for it, so that code that does not wait meets old bytes. It
// shows the results of a kernel, and waits that do not fit together; not races within a warp's step, nor speed.
//
// Copies of the sources are compiled: of `__shared__ type name;` the build makes a call of emulated_device::shared()
// (copy_source.cmake), and a test can put faults in force in them (faults.cmake).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <source_location>
#include <tuple>
#include <type_traits>
#ifndef __cpp_lib_source_location
#include <experimental/source_location>
#endif

#include "faults.hpp"

#define __global__
#define __device__
#define __host__
#define __grid_constant__
#define __launch_bounds__(...)

struct float4 {
    float x, y, z, w;
};
struct dim3 {
    dim3(unsigned count = 1) : x(count) {}
    unsigned x, y = 1, z = 1;
};
using cudaStream_t = struct EmulatedStream*;

namespace emulated_device {

struct Index {
    unsigned x = 0;
};
extern Index thread_index, block_index, block_size, grid_size;

/// The kinds of meetings for which the lanes of a warp, or the threads of a block or grid, wait together.
enum class Meeting : std::uint8_t { sync_warp, ballot, shuffle, shuffle_up, shuffle_xor, sync_block, sync_grid };
#ifdef __cpp_lib_source_location
using Place = std::source_location;
#else
// What clang-tidy 14 finds beside this compiler's library.
using Place = std::experimental::source_location;
#endif

/// Waits for all threads of the block or grid, which must come to the same place.
void wait_for_block(Place place);
void wait_for_grid(Place place);
/// Lets every lane see the values that the lanes of its warp have given, once all lanes of the mask have: to the same
/// meeting at the same place, by the same mask.
const std::uint64_t* exchange(std::uint64_t value, unsigned mask, Meeting meeting, Place place);

/// Memory of the running block, the same for all that ask in one line; rubbish when the block begins.
void* shared_memory(std::size_t bytes, std::size_t alignment, unsigned line);
template <class T>
T& shared(Place place = Place::current()) {
    static_assert(std::is_trivially_default_constructible_v<std::remove_all_extents_t<T>>);
    return *static_cast<T*>(shared_memory(sizeof(T), alignof(T), place.line()));
}

/// Puts work into the stream, or the graph that it is being captured into.
void submit(cudaStream_t stream, const std::function<void()>& work);
/// Called, if there, whenever a thread asks the clock.
extern std::function<void()> on_clock;
/// Called, if there, as a kernel begins to run.
extern std::function<void(bool cooperative)> on_kernel;
/// Called, if there, by the thread that makes an atomic addition, with its address.
extern std::function<void(const void* at)> on_addition;
void run_kernel(unsigned blocks, unsigned threads, bool cooperative, const std::function<void()>& kernel);
/// Seed of the shuffles that choose the next thread; the same seed gives the same order.
void seed_order(unsigned seed);

/// Runs kernels in place of this device's threads, if set: with the addresses of the arguments.
struct KernelRunner {
    std::function<void(const void* kernel, unsigned blocks, unsigned threads, bool cooperative, void* const* arguments)>
        run;
    unsigned processors = 1;                                     ///< number of multiprocessors that the backend sees
    std::function<int(const void* kernel)> blocks_of_processor;  ///< number of blocks that run at once on one
};
extern KernelRunner* runner;

/// The properties of the device.
inline constexpr unsigned processors = 1;
inline constexpr unsigned blocks_of_processor = 4;

template <class T>
T shuffled(T value, unsigned from, unsigned mask, Meeting meeting, Place place) {
    std::uint64_t bits = 0;
    static_assert(sizeof(T) <= sizeof(bits));
    __builtin_memcpy(&bits, &value, sizeof(T));
    bits = exchange(bits, mask, meeting, place)[from];
    __builtin_memcpy(&value, &bits, sizeof(T));
    return value;
}

}  // namespace emulated_device

inline emulated_device::Index& threadIdx = emulated_device::thread_index;
inline emulated_device::Index& blockIdx = emulated_device::block_index;
inline emulated_device::Index& blockDim = emulated_device::block_size;
inline emulated_device::Index& gridDim = emulated_device::grid_size;

/// A clock that ticks in long steps: a question every few milliseconds is asked every time.
inline long long clock64() {
    static long long now = 0;
    if (emulated_device::on_clock) emulated_device::on_clock();
    return now += 1LL << 30;
}
inline int __popc(unsigned bits) {
    return __builtin_popcount(bits);
}
inline void __syncthreads(emulated_device::Place place = emulated_device::Place::current()) {
    emulated_device::wait_for_block(place);
}
/// Fibers of one thread of the host see each other's writes in their order.
inline void __threadfence() {}
inline void __syncwarp(unsigned mask = ~0U, emulated_device::Place place = emulated_device::Place::current()) {
    emulated_device::exchange(0, mask, emulated_device::Meeting::sync_warp, place);
}
inline unsigned __ballot_sync(unsigned mask, int predicate,
                              emulated_device::Place place = emulated_device::Place::current()) {
    const std::uint64_t* given =
        emulated_device::exchange(predicate != 0, mask, emulated_device::Meeting::ballot, place);
    unsigned result = 0;
    for (unsigned lane = 0; lane < 32; ++lane)
        if ((mask >> lane & 1) != 0) result |= static_cast<unsigned>(given[lane]) << lane;
    return result;
}
template <class T>
T __shfl_sync(unsigned mask, T value, int lane, emulated_device::Place place = emulated_device::Place::current()) {
    return emulated_device::shuffled(value, static_cast<unsigned>(lane) % 32, mask, emulated_device::Meeting::shuffle,
                                     place);
}
template <class T>
T __shfl_up_sync(unsigned mask, T value, unsigned distance,
                 emulated_device::Place place = emulated_device::Place::current()) {
    const unsigned lane = threadIdx.x % 32;
    return emulated_device::shuffled(value, lane >= distance ? lane - distance : lane, mask,
                                     emulated_device::Meeting::shuffle_up, place);
}
template <class T>
T __shfl_xor_sync(unsigned mask, T value, int with, emulated_device::Place place = emulated_device::Place::current()) {
    return emulated_device::shuffled(value, (threadIdx.x % 32) ^ static_cast<unsigned>(with), mask,
                                     emulated_device::Meeting::shuffle_xor, place);
}
inline unsigned __float_as_uint(float value) {
    return __builtin_bit_cast(unsigned, value);
}
template <class T>
T atomicAdd(T* at, T value) {
    if (emulated_device::on_addition) emulated_device::on_addition(at);
    const T before = *at;
    *at += value;
    return before;
}
template <class T>
T atomicMax(T* at, T value) {
    const T before = *at;
    if (value > before) *at = value;
    return before;
}
template <class T>
T atomicOr(T* at, T value) {
    const T before = *at;
    *at |= value;
    return before;
}
template <class T>
T atomicAnd(T* at, T value) {
    const T before = *at;
    *at &= value;
    return before;
}

// ---- the part of the runtime that the backend uses ------------------------------------------------------------------

enum cudaError_t {
    cudaSuccess,
    cudaErrorMemoryAllocation,
    cudaErrorLaunchFailure,
    cudaErrorInvalidValue,
    cudaErrorHostMemoryNotRegistered,
    cudaErrorInvalidConfiguration,
    cudaErrorNotReady,
    cudaErrorCooperativeLaunchTooLarge,
    cudaErrorStreamCaptureUnsupported,  ///< for calls that would wait or allocate while this thread captures a graph
};
namespace emulated_device {
/// Called, if set, before every copy to the host, in the thread that asks for it; its answer is the copy's status.
extern std::function<cudaError_t()> before_copy_to_host;
}  // namespace emulated_device
enum cudaDeviceAttr { cudaDevAttrMultiProcessorCount };
enum cudaDriverEntryPointQueryResult { cudaDriverEntryPointSymbolNotFound };
enum cudaMemcpyKind { cudaMemcpyHostToDevice, cudaMemcpyDeviceToHost, cudaMemcpyDeviceToDevice };
enum cudaMemoryType { cudaMemoryTypeUnregistered, cudaMemoryTypeHost, cudaMemoryTypeDevice, cudaMemoryTypeManaged };
struct cudaPointerAttributes {
    cudaMemoryType type;
    int device;
};
enum cudaStreamCaptureMode { cudaStreamCaptureModeThreadLocal };
enum cudaMemAllocationType { cudaMemAllocationTypePinned };
enum cudaMemLocationType { cudaMemLocationTypeDevice };
enum cudaFuncAttribute { cudaFuncAttributePreferredSharedMemoryCarveout };
constexpr int cudaSharedmemCarveoutMaxShared = 100;
enum cudaLaunchAttributeID { cudaLaunchAttributeCooperative };
constexpr unsigned cudaStreamNonBlocking = 1;
constexpr unsigned cudaEventRecordExternal = 1;
constexpr unsigned cudaEventDefault = 0;
constexpr unsigned cudaEventBlockingSync = 1;
constexpr unsigned cudaEventDisableTiming = 2;
constexpr unsigned cudaHostRegisterPortable = 1;
constexpr unsigned cudaHostRegisterMapped = 2;
constexpr unsigned long long cudaEnableDefault = 0;

using cudaMemPool_t = struct EmulatedPool*;
using cudaEvent_t = struct EmulatedEvent*;
using cudaGraph_t = struct EmulatedGraph*;
using cudaGraphExec_t = struct EmulatedGraph*;

struct cudaMemPoolProps {
    cudaMemAllocationType allocType;
    struct {
        cudaMemLocationType type;
        int id;
    } location;
};
struct cudaLaunchAttribute {
    cudaLaunchAttributeID id;
    struct {
        int cooperative;
    } val;
};
struct cudaLaunchConfig_t {
    dim3 gridDim, blockDim;
    std::size_t dynamicSmemBytes;
    cudaStream_t stream;
    cudaLaunchAttribute* attrs;
    unsigned numAttrs;
};

/// Attributes of a kernel; this device has no registers.
struct cudaFuncAttributes {
    int numRegs;
    std::size_t sharedSizeBytes;
};

const char* cudaGetErrorString(cudaError_t);
namespace emulated_device {
/// Kernels that have asked for as much shared memory as there is.
extern std::set<const void*> most_shared;
}  // namespace emulated_device
cudaError_t cudaFuncSetAttribute(const void* kernel, cudaFuncAttribute, int value);
cudaError_t cudaFuncGetAttributes(cudaFuncAttributes*, const void* kernel);
/// The mangled name; cudaErrorInvalidValue for an address that is no function of this program.
cudaError_t cudaFuncGetName(const char** name, const void* kernel);
cudaError_t cudaGetLastError();
cudaError_t cudaGetDevice(int* device);
cudaError_t cudaSetDevice(int device);
cudaError_t cudaGetDriverEntryPointByVersion(const char* name, void** entry, unsigned version, unsigned long long,
                                             cudaDriverEntryPointQueryResult*);
cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr, int device);
cudaError_t cudaStreamCreateWithFlags(cudaStream_t*, unsigned);
cudaError_t cudaStreamSynchronize(cudaStream_t);
cudaError_t cudaStreamWaitEvent(cudaStream_t, cudaEvent_t, unsigned);
cudaError_t cudaStreamDestroy(cudaStream_t);
cudaError_t cudaStreamBeginCapture(cudaStream_t, cudaStreamCaptureMode);
cudaError_t cudaStreamEndCapture(cudaStream_t, cudaGraph_t*);
cudaError_t cudaGraphInstantiate(cudaGraphExec_t*, cudaGraph_t, unsigned long long);
cudaError_t cudaGraphLaunch(cudaGraphExec_t, cudaStream_t);
cudaError_t cudaGraphDestroy(cudaGraph_t);
cudaError_t cudaGraphExecDestroy(cudaGraphExec_t);
cudaError_t cudaEventCreateWithFlags(cudaEvent_t*, unsigned);
cudaError_t cudaEventDestroy(cudaEvent_t);
cudaError_t cudaEventRecord(cudaEvent_t, cudaStream_t);
cudaError_t cudaEventRecordWithFlags(cudaEvent_t, cudaStream_t, unsigned);
cudaError_t cudaEventSynchronize(cudaEvent_t);
/// What the event waits for is not done before the host waits for it.
cudaError_t cudaEventQuery(cudaEvent_t);
cudaError_t cudaEventElapsedTime(float* milliseconds, cudaEvent_t, cudaEvent_t);
cudaError_t cudaMemPoolCreate(cudaMemPool_t*, const cudaMemPoolProps*);
cudaError_t cudaMemPoolDestroy(cudaMemPool_t);
cudaError_t cudaMallocFromPoolAsync(void** memory, std::size_t bytes, cudaMemPool_t, cudaStream_t);
cudaError_t cudaFreeAsync(void* memory, cudaStream_t);
/// Host, for all that cudaMallocFromPoolAsync has not given.
cudaError_t cudaPointerGetAttributes(cudaPointerAttributes*, const void* memory);
cudaError_t cudaMallocHost(void** memory, std::size_t bytes);
cudaError_t cudaHostRegister(void* memory, std::size_t bytes, unsigned);
cudaError_t cudaHostUnregister(void* memory);
cudaError_t cudaHostGetDevicePointer(void** mapped, void* memory, unsigned);
cudaError_t cudaFreeHost(void* memory);
cudaError_t cudaMemsetAsync(void* memory, int value, std::size_t bytes, cudaStream_t);
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind, cudaStream_t);

template <class Kernel>
cudaError_t cudaOccupancyMaxActiveBlocksPerMultiprocessor(int* blocks, Kernel kernel, int, std::size_t) {
    *blocks = emulated_device::runner == nullptr
                  ? static_cast<int>(emulated_device::blocks_of_processor)
                  : emulated_device::runner->blocks_of_processor(reinterpret_cast<const void*>(kernel));
    return cudaSuccess;
}
template <class... Parameters, class... Arguments>
cudaError_t cudaLaunchKernelEx(const cudaLaunchConfig_t* configuration, void (*kernel)(Parameters...),
                               const Arguments&... arguments) {
    const unsigned blocks = configuration->gridDim.x;
    const unsigned threads = configuration->blockDim.x;
    const bool cooperative = configuration->numAttrs != 0 && configuration->attrs->val.cooperative != 0;
    if (blocks == 0 || threads == 0 || threads > 1024 || threads % 32 != 0) return cudaErrorInvalidConfiguration;
    if (emulated_device::runner != nullptr) {
        emulated_device::submit(configuration->stream, [=, values = std::tuple<Parameters...>(arguments...)]() mutable {
            std::apply(
                [&](auto&... value) {
                    void* const addresses[] = {&value...};
                    emulated_device::runner->run(reinterpret_cast<const void*>(kernel), blocks, threads, cooperative,
                                                 addresses);
                },
                values);
        });
        return cudaSuccess;
    }
    if (cooperative && blocks > emulated_device::processors * emulated_device::blocks_of_processor)
        return cudaErrorCooperativeLaunchTooLarge;
    emulated_device::submit(configuration->stream, [=] {
        emulated_device::run_kernel(blocks, threads, cooperative, [=] { kernel(arguments...); });
    });
    return cudaSuccess;
}
