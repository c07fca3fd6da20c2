// CUB, compiled once.
#include "engine/cuda/scans.hpp"

#include <algorithm>

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

#include "engine/cuda/launch_observer.hpp"

namespace meniscus::cuda {
namespace {

struct Plus {
    template <class T>
    __host__ __device__ T operator()(const T& a, const T& b) const {
        return a + b;
    }
};

/// Null memory: only tells the bytes needed.
template <class T>
void scan(void* memory, std::size_t& bytes, T* values, std::size_t n, cudaStream_t stream) {
    check(cub::DeviceScan::ExclusiveScan(memory, bytes, values, values, Plus{}, T{}, static_cast<std::int64_t>(n),
                                         stream),
          "cub::DeviceScan");
}

template <class Key>
Key* sort_keys(void* memory, std::size_t& bytes, Key* keys, Key* room, std::size_t n, cudaStream_t stream) {
    cub::DoubleBuffer<Key> buffers(keys, room);
    check(cub::DeviceRadixSort::SortKeys(memory, bytes, buffers, static_cast<std::int64_t>(n), 0,
                                         static_cast<int>(8 * sizeof(Key)), stream),
          "cub::DeviceRadixSort");
    return buffers.Current();
}

SortKey* sort_pairs(void* memory, std::size_t& bytes, SortKey* keys, SortKey* room, std::uint32_t* values,
                    std::uint32_t* values_room, std::size_t n, cudaStream_t stream) {
    cub::DoubleBuffer<SortKey> key_buffers(keys, room);
    cub::DoubleBuffer<std::uint32_t> value_buffers(values, values_room);
    check(cub::DeviceRadixSort::SortPairs(memory, bytes, key_buffers, value_buffers, static_cast<std::int64_t>(n), 0,
                                          static_cast<int>(8 * sizeof(SortKey)), stream),
          "cub::DeviceRadixSort");
    if (memory != nullptr && value_buffers.Current() != values)
        check(cudaMemcpyAsync(values, value_buffers.Current(), n * sizeof(std::uint32_t), cudaMemcpyDeviceToDevice,
                              stream),
              "cudaMemcpyAsync");
    return key_buffers.Current();
}

Launch sum_of(std::uint64_t n, std::size_t bytes, cudaStream_t stream) {
    return {.kind = LaunchKind::sum, .stream = stream, .elements = n, .element_bytes = bytes};
}
Launch sort_of(std::uint64_t n, std::size_t bytes, cudaStream_t stream) {
    return {.kind = LaunchKind::sort, .stream = stream, .elements = n, .element_bytes = bytes};
}

template <class T>
std::size_t scan_bytes(std::size_t n) {
    std::size_t bytes = 0;
    scan<T>(nullptr, bytes, nullptr, n, nullptr);
    return bytes;
}

template <class Key>
std::size_t sort_bytes(std::size_t n) {
    std::size_t bytes = 0;
    sort_keys<Key>(nullptr, bytes, nullptr, nullptr, n, nullptr);
    return bytes;
}

}  // namespace

std::size_t scratch_bytes(std::size_t particle_keys, bool has_values, std::size_t brick_keys, std::size_t sums) {
    std::size_t pair_bytes = 0;
    if (has_values) sort_pairs(nullptr, pair_bytes, nullptr, nullptr, nullptr, nullptr, particle_keys, nullptr);
    return std::max({pair_bytes, sort_bytes<SortKey>(particle_keys), sort_bytes<std::uint64_t>(brick_keys),
                     scan_bytes<std::uint32_t>(sums), scan_bytes<std::uint64_t>(sums), scan_bytes<LevelCounts>(sums)});
}

void exclusive_sum(const Scratch& scratch, std::uint32_t* values, std::size_t n, cudaStream_t stream) {
    const ObservedLaunch observed(sum_of(n, sizeof(*values), stream));
    std::size_t bytes = scratch.bytes;
    scan(scratch.memory, bytes, values, n, stream);
}
void exclusive_sum(const Scratch& scratch, std::uint64_t* values, std::size_t n, cudaStream_t stream) {
    const ObservedLaunch observed(sum_of(n, sizeof(*values), stream));
    std::size_t bytes = scratch.bytes;
    scan(scratch.memory, bytes, values, n, stream);
}
void exclusive_sum(const Scratch& scratch, LevelCounts* values, std::size_t n, cudaStream_t stream) {
    const ObservedLaunch observed(sum_of(n, sizeof(*values), stream));
    std::size_t bytes = scratch.bytes;
    scan(scratch.memory, bytes, values, n, stream);
}

SortKey* sort(const Scratch& scratch, SortKey* keys, SortKey* room, std::size_t n, cudaStream_t stream) {
    const ObservedLaunch observed(sort_of(n, sizeof(*keys), stream));
    std::size_t bytes = scratch.bytes;
    return sort_keys(scratch.memory, bytes, keys, room, n, stream);
}
SortKey* sort_with_values(const Scratch& scratch, SortKey* keys, SortKey* room, std::uint32_t* values,
                          std::uint32_t* values_room, std::size_t n, cudaStream_t stream) {
    const ObservedLaunch observed(sort_of(n, sizeof(*keys) + sizeof(*values), stream));
    std::size_t bytes = scratch.bytes;
    return sort_pairs(scratch.memory, bytes, keys, room, values, values_room, n, stream);
}
std::uint64_t* sort(const Scratch& scratch, std::uint64_t* keys, std::uint64_t* room, std::size_t n,
                    cudaStream_t stream) {
    const ObservedLaunch observed(sort_of(n, sizeof(*keys), stream));
    std::size_t bytes = scratch.bytes;
    return sort_keys(scratch.memory, bytes, keys, room, n, stream);
}

}  // namespace meniscus::cuda
