// In place of CUB.
#include "engine/cuda/scans.hpp"

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

namespace meniscus::cuda {
namespace {

template <class T>
void sum(T* values, std::size_t n, cudaStream_t stream) {
    emulated_device::submit(stream, [=] {
        T total{};
        for (std::size_t i = 0; i < n; ++i) {
            const T own = values[i];
            values[i] = total;
            total = total + own;
        }
    });
}

template <class Key>
Key* sorted(Key* keys, Key* room, std::size_t n, cudaStream_t stream) {
    // In the other array, as CUB may have it too.
    emulated_device::submit(stream, [=] {
        std::copy(keys, keys + n, room);
        std::sort(room, room + n);
    });
    return room;
}

}  // namespace

std::size_t scratch_bytes(std::size_t, bool, std::size_t, std::size_t) {
    return 256;
}
void exclusive_sum(const Scratch&, std::uint32_t* values, std::size_t n, cudaStream_t stream) {
    sum(values, n, stream);
}
void exclusive_sum(const Scratch&, std::uint64_t* values, std::size_t n, cudaStream_t stream) {
    sum(values, n, stream);
}
void exclusive_sum(const Scratch&, LevelCounts* values, std::size_t n, cudaStream_t stream) {
    sum(values, n, stream);
}
SortKey* sort(const Scratch&, SortKey* keys, SortKey* room, std::size_t n, cudaStream_t stream) {
    return sorted(keys, room, n, stream);
}
SortKey* sort_with_values(const Scratch&, SortKey* keys, SortKey* room, std::uint32_t* values, std::uint32_t*,
                          std::size_t n, cudaStream_t stream) {
    emulated_device::submit(stream, [=] {
        std::vector<std::pair<SortKey, std::uint32_t>> pairs(n);
        for (std::size_t i = 0; i < n; ++i) pairs[i] = {keys[i], values[i]};
        std::stable_sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        for (std::size_t i = 0; i < n; ++i) std::tie(room[i], values[i]) = pairs[i];
    });
    return room;
}
std::uint64_t* sort(const Scratch&, std::uint64_t* keys, std::uint64_t* room, std::size_t n, cudaStream_t stream) {
    return sorted(keys, room, n, stream);
}

}  // namespace meniscus::cuda
