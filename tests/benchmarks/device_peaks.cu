#include <cuda_runtime.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "device_peaks.hpp"

namespace meniscus::benchmarks {
namespace {

void check(cudaError_t status) {
    if (status != cudaSuccess) throw std::runtime_error(std::string("CUDA: ") + cudaGetErrorString(status));
}

struct FreeDevice {
    void operator()(void* memory) const { cudaFree(memory); }
};
using DeviceMemory = std::unique_ptr<void, FreeDevice>;

DeviceMemory allocate(std::size_t bytes) {
    void* memory = nullptr;
    check(cudaMalloc(&memory, bytes));
    return DeviceMemory(memory);
}

struct DestroyEvent {
    void operator()(cudaEvent_t event) const { cudaEventDestroy(event); }
};
using Event = std::unique_ptr<std::remove_pointer_t<cudaEvent_t>, DestroyEvent>;

Event make_event() {
    cudaEvent_t event = nullptr;
    check(cudaEventCreate(&event));
    return Event(event);
}

struct DestroyStream {
    void operator()(cudaStream_t stream) const { cudaStreamDestroy(stream); }
};
using Stream = std::unique_ptr<std::remove_pointer_t<cudaStream_t>, DestroyStream>;

Stream make_stream() {
    cudaStream_t stream = nullptr;
    check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking));
    return Stream(stream);
}

/// The most of `amount` per second over some tries of `work`, the first of which finds a cold device.
template <class Work>
double best_rate(double amount, cudaStream_t stream, const Work& work) {
    constexpr int tries = 15;
    const Event begin = make_event();
    const Event end = make_event();
    double best = 0.0;
    for (int i = 0; i < tries; ++i) {
        check(cudaEventRecord(begin.get(), stream));
        work();
        check(cudaEventRecord(end.get(), stream));
        check(cudaEventSynchronize(end.get()));
        float milliseconds = 0.0F;
        check(cudaEventElapsedTime(&milliseconds, begin.get(), end.get()));
        best = std::max(best, 1e3 * amount / static_cast<double>(milliseconds));
    }
    return best;
}

constexpr int sums = 8;  ///< sums that begin differently, or they would be one; enough to hide an addition's latency
constexpr int rounds = 8192;

__global__ void multiply_add(float factor, float summand, float* out) {
    float sum[sums];
#pragma unroll
    for (int i = 0; i < sums; ++i) sum[i] = static_cast<float>(threadIdx.x + static_cast<unsigned>(i));
    for (int round = 0; round < rounds; ++round) {
#pragma unroll
        for (int i = 0; i < sums; ++i) sum[i] = __fmaf_rn(sum[i], factor, summand);
    }
    float total = 0.0F;
#pragma unroll
    for (int i = 0; i < sums; ++i) total += sum[i];
    out[blockIdx.x * blockDim.x + threadIdx.x] = total;
}

double measure_multiply_adds(cudaStream_t stream) {
    constexpr int threads = 256;
    constexpr int blocks_per_multiprocessor = 32;
    int device = 0;
    int multiprocessors = 0;
    check(cudaGetDevice(&device));
    check(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device));
    const int blocks = multiprocessors * blocks_per_multiprocessor;
    const std::size_t lanes = static_cast<std::size_t>(blocks) * threads;
    const DeviceMemory out = allocate(lanes * sizeof(float));
    return best_rate(static_cast<double>(lanes) * sums * rounds, stream, [&] {
        multiply_add<<<blocks, threads, 0, stream>>>(0.999F, 0.001F, static_cast<float*>(out.get()));
        check(cudaGetLastError());
    });
}

double measure_copies(cudaStream_t stream) {
    std::size_t available = 0;
    std::size_t total = 0;
    check(cudaMemGetInfo(&available, &total));
    const std::size_t bytes = std::min(std::size_t{1} << 30, available / 4);
    const DeviceMemory from = allocate(bytes);
    const DeviceMemory to = allocate(bytes);
    check(cudaMemsetAsync(from.get(), 1, bytes, stream));
    return best_rate(static_cast<double>(bytes), stream,
                     [&] { check(cudaMemcpyAsync(to.get(), from.get(), bytes, cudaMemcpyDeviceToDevice, stream)); });
}

}  // namespace

MachinePeaks measure_device_peaks() {
    const Stream stream = make_stream();
    return {measure_multiply_adds(stream.get()), measure_copies(stream.get())};
}

}  // namespace meniscus::benchmarks
