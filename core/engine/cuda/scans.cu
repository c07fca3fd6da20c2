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

/// Sums; with null memory only the number of needed bytes is set.
template <class T>
void scan(void* memory, std::size_t& bytes, T* values, std::size_t n, cudaStream_t stream) {
    check(cub::DeviceScan::ExclusiveScan(memory, bytes, values, values, Plus{}, T{}, static_cast<std::int64_t>(n),
                                         stream),
          "cub::DeviceScan");
}

std::uint64_t* sort_keys(void* memory, std::size_t& bytes, std::uint64_t* keys, std::uint64_t* room, std::size_t n,
                         unsigned bits, cudaStream_t stream) {
    cub::DoubleBuffer<std::uint64_t> buffers(keys, room);
    check(cub::DeviceRadixSort::SortKeys(memory, bytes, buffers, static_cast<std::int64_t>(n), 0,
                                         static_cast<int>(bits), stream),
          "cub::DeviceRadixSort");
    return buffers.Current();
}

SortedPairs sort_pairs(void* memory, std::size_t& bytes, SortedPairs pairs, SortedPairs room, std::size_t n,
                       unsigned bits, cudaStream_t stream) {
    cub::DoubleBuffer<std::uint64_t> keys(pairs.keys, room.keys);
    cub::DoubleBuffer<std::uint32_t> values(pairs.values, room.values);
    check(cub::DeviceRadixSort::SortPairs(memory, bytes, keys, values, static_cast<std::int64_t>(n), 0,
                                          static_cast<int>(bits), stream),
          "cub::DeviceRadixSort");
    return {keys.Current(), values.Current()};
}

Launch sum_of(std::uint64_t n, std::size_t bytes, cudaStream_t stream) {
    return {.kind = LaunchKind::sum, .stream = stream, .elements = n, .element_bytes = bytes};
}
Launch sort_of(std::uint64_t n, std::size_t bytes, unsigned key_bits, cudaStream_t stream) {
    return {.kind = LaunchKind::sort, .stream = stream, .elements = n, .element_bytes = bytes, .key_bits = key_bits};
}

template <class T>
std::size_t scan_bytes(std::size_t n) {
    std::size_t bytes = 0;
    scan<T>(nullptr, bytes, nullptr, n, nullptr);
    return bytes;
}

}  // namespace

std::size_t scratch_bytes(std::size_t particle_keys, std::size_t brick_keys, std::size_t sums) {
    std::size_t pair_bytes = 0;
    std::size_t key_bytes = 0;
    sort_pairs(nullptr, pair_bytes, {}, {}, particle_keys, 64, nullptr);
    sort_keys(nullptr, key_bytes, nullptr, nullptr, brick_keys, 64, nullptr);
    return std::max({pair_bytes, key_bytes, scan_bytes<std::uint32_t>(sums), scan_bytes<std::uint64_t>(sums),
                     scan_bytes<LevelCounts>(sums)});
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

std::uint64_t* sort(const Scratch& scratch, std::uint64_t* keys, std::uint64_t* room, std::size_t n, unsigned bits,
                    cudaStream_t stream) {
    const ObservedLaunch observed(sort_of(n, sizeof(*keys), bits, stream));
    std::size_t bytes = scratch.bytes;
    return sort_keys(scratch.memory, bytes, keys, room, n, bits, stream);
}
SortedPairs sort_with_values(const Scratch& scratch, SortedPairs pairs, SortedPairs room, std::size_t n, unsigned bits,
                             cudaStream_t stream) {
    const ObservedLaunch observed(sort_of(n, sizeof(*pairs.keys) + sizeof(*pairs.values), bits, stream));
    std::size_t bytes = scratch.bytes;
    return sort_pairs(scratch.memory, bytes, pairs, room, n, bits, stream);
}

}  // namespace meniscus::cuda
