// A device in software, so that the CUDA backend's kernels run where there is no GPU: this stands in for CUDA's own
// header when they are compiled as C++. Every thread of a block is a fiber; fibers change where threads wait for each
// other, in an order of chance; blocks run one after the other, but for cooperative kernels, which get a single one.
// Work waits in its stream until the host waits for it, so that whoever does not wait meets old bytes. It shows what a
// kernel computes; not races of memory, nor speed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#define __global__
#define __device__
#define __host__
#define __grid_constant__
#define __launch_bounds__(...)
#define __shared__ static

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

/// Waits for all threads of the warp, block or grid. `place` must be the same in all of them.
void wait_for_warp(int place);
void wait_for_block();
void wait_for_grid();
/// Lets every lane see what the lanes of its warp have given, once all have.
const std::uint64_t* exchange(std::uint64_t value, int place);

/// Into the stream, or the graph that it is being captured into.
void submit(cudaStream_t stream, const std::function<void()>& work);
/// Called, if there, whenever a thread asks the clock.
extern std::function<void()> on_clock;
void run_kernel(unsigned blocks, unsigned threads, const std::function<void()>& kernel);

template <class T>
T shuffled(T value, unsigned from, int place) {
    std::uint64_t bits = 0;
    static_assert(sizeof(T) <= sizeof(bits));
    __builtin_memcpy(&bits, &value, sizeof(T));
    bits = exchange(bits, place)[from];
    __builtin_memcpy(&value, &bits, sizeof(T));
    return value;
}

}  // namespace emulated_device

inline emulated_device::Index& threadIdx = emulated_device::thread_index;
inline emulated_device::Index& blockIdx = emulated_device::block_index;
inline emulated_device::Index& blockDim = emulated_device::block_size;
inline emulated_device::Index& gridDim = emulated_device::grid_size;

/// A clock that ticks in long steps: whoever asks something every few milliseconds asks it every time.
inline long long clock64() {
    static long long now = 0;
    if (emulated_device::on_clock) emulated_device::on_clock();
    return now += 1LL << 30;
}
inline int __popc(unsigned bits) {
    return __builtin_popcount(bits);
}
inline void __syncthreads() {
    emulated_device::wait_for_block();
}
inline void __syncwarp(int place = __builtin_LINE()) {
    emulated_device::wait_for_warp(place);
}
inline unsigned __ballot_sync(unsigned, int predicate, int place = __builtin_LINE()) {
    const std::uint64_t* given = emulated_device::exchange(predicate != 0, place);
    unsigned result = 0;
    for (unsigned lane = 0; lane < 32; ++lane) result |= static_cast<unsigned>(given[lane]) << lane;
    return result;
}
template <class T>
T __shfl_sync(unsigned, T value, int lane, int place = __builtin_LINE()) {
    return emulated_device::shuffled(value, static_cast<unsigned>(lane), place);
}
template <class T>
T __shfl_up_sync(unsigned, T value, unsigned distance, int place = __builtin_LINE()) {
    const unsigned lane = threadIdx.x % 32;
    return emulated_device::shuffled(value, lane >= distance ? lane - distance : lane, place);
}
template <class T>
T __shfl_xor_sync(unsigned, T value, int mask, int place = __builtin_LINE()) {
    return emulated_device::shuffled(value, (threadIdx.x % 32) ^ static_cast<unsigned>(mask), place);
}
inline unsigned __float_as_uint(float value) {
    return __builtin_bit_cast(unsigned, value);
}
template <class T>
T atomicAdd(T* at, T value) {
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

// ---- the part of the runtime that the backend uses ------------------------------------------------------------------

enum cudaError_t { cudaSuccess, cudaErrorMemoryAllocation, cudaErrorLaunchFailure };
namespace emulated_device {
/// Called, if there, before every copy to the host, by whoever asks for that; what it answers is the copy's status.
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
enum cudaLaunchAttributeID { cudaLaunchAttributeCooperative };
constexpr unsigned cudaStreamNonBlocking = 1;
constexpr unsigned cudaEventRecordExternal = 1;
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

const char* cudaGetErrorString(cudaError_t);
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
cudaError_t cudaEventCreate(cudaEvent_t*);
cudaError_t cudaEventDestroy(cudaEvent_t);
cudaError_t cudaEventRecord(cudaEvent_t, cudaStream_t);
cudaError_t cudaEventRecordWithFlags(cudaEvent_t, cudaStream_t, unsigned);
cudaError_t cudaEventSynchronize(cudaEvent_t);
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
cudaError_t cudaOccupancyMaxActiveBlocksPerMultiprocessor(int* blocks, Kernel, int, std::size_t) {
    *blocks = 1;
    return cudaSuccess;
}
template <class... Parameters, class... Arguments>
cudaError_t cudaLaunchKernelEx(const cudaLaunchConfig_t* configuration, void (*kernel)(Parameters...),
                               const Arguments&... arguments) {
    const unsigned blocks = configuration->gridDim.x;
    const unsigned threads = configuration->blockDim.x;
    emulated_device::submit(configuration->stream,
                            [=] { emulated_device::run_kernel(blocks, threads, [=] { kernel(arguments...); }); });
    return cudaSuccess;
}
