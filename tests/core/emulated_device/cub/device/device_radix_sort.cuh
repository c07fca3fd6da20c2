// In the place of CUB's header; see contract.hpp.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "cub/contract.hpp"

namespace cub {

template <class T>
struct DoubleBuffer {
    T* d_buffers[2];
    int selector = 0;

    DoubleBuffer(T* current, T* alternate) : d_buffers{current, alternate} {}
    T* Current() const { return d_buffers[selector]; }
    T* Alternate() const { return d_buffers[selector ^ 1]; }
};

/// CUB chooses the buffer that holds the result: here another one from call to call. The other buffer holds rubbish.
struct DeviceRadixSort {
    template <class Key>
    static cudaError_t SortKeys(void* memory, std::size_t& bytes, DoubleBuffer<Key>& keys, std::int64_t n,
                                int begin_bit, int end_bit, cudaStream_t stream) {
        DoubleBuffer<char> no_values(nullptr, nullptr);
        return sort<false>(memory, bytes, keys, no_values, n, begin_bit, end_bit, stream);
    }
    /// Equal keys keep their order.
    template <class Key, class Value>
    static cudaError_t SortPairs(void* memory, std::size_t& bytes, DoubleBuffer<Key>& keys, DoubleBuffer<Value>& values,
                                 std::int64_t n, int begin_bit, int end_bit, cudaStream_t stream) {
        return sort<true>(memory, bytes, keys, values, n, begin_bit, end_bit, stream);
    }

private:
    template <class T>
    static bool is_double(const DoubleBuffer<T>& buffers, std::size_t count) {
        return emulated_device::are_apart(buffers.Current(), buffers.Alternate(), count * sizeof(T));
    }

    template <bool has_values, class Key, class Value>
    static cudaError_t sort(void* memory, std::size_t& bytes, DoubleBuffer<Key>& keys, DoubleBuffer<Value>& values,
                            std::int64_t n, int begin_bit, int end_bit, cudaStream_t stream) {
        const auto count = static_cast<std::size_t>(n);
        constexpr int key_bits = 8 * sizeof(Key);
        if (n < 0 || begin_bit != 0 || end_bit < 1 || end_bit > key_bits) return cudaErrorInvalidValue;
        const Key ordered = static_cast<Key>(~Key{0}) >> (key_bits - end_bit);
        if (memory != nullptr && (!is_double(keys, count) || (has_values && !is_double(values, count))))
            return cudaErrorInvalidValue;
        const std::size_t needed = 1024 + count / 16 * (has_values ? 3 : 2);
        Key* const from = keys.Current();
        Key* const other = keys.Alternate();
        Value* const values_from = values.Current();
        Value* const other_values = values.Alternate();
        static int calls = 0;
        if (memory != nullptr) ++calls;
        const int changes = calls & 1;
        const auto work = [=] {
            std::vector<std::size_t> order(count);
            std::iota(order.begin(), order.end(), std::size_t{0});
            std::stable_sort(order.begin(), order.end(),
                             [&](auto a, auto b) { return (from[a] & ordered) < (from[b] & ordered); });
            permute(order, from, other, changes != 0);
            if constexpr (has_values) permute(order, values_from, other_values, changes != 0);
        };
        const cudaError_t status = emulated_device::with_scratch(memory, bytes, needed, stream, work);
        if (memory == nullptr || status != cudaSuccess) return status;
        keys.selector ^= changes;
        values.selector ^= changes;
        return status;
    }

    template <class T>
    static void permute(const std::vector<std::size_t>& order, T* from, T* other, bool changes) {
        std::vector<T> sorted(order.size());
        for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = from[order[i]];
        std::copy(sorted.begin(), sorted.end(), changes ? other : from);
        std::fill_n(reinterpret_cast<std::byte*>(changes ? from : other), order.size() * sizeof(T), std::byte{0x5A});
    }
};

}  // namespace cub
