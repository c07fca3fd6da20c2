// In the place of CUB's header; see contract.hpp.
#pragma once

#include "cub/contract.hpp"

namespace cub {

struct DeviceScan {
    /// from and to may be the same.
    template <class T, class Sum>
    static cudaError_t ExclusiveScan(void* memory, std::size_t& bytes, const T* from, T* to, Sum sum, T first,
                                     std::int64_t n, cudaStream_t stream) {
        const auto count = static_cast<std::size_t>(n);
        if (n < 0 || (memory != nullptr && from != to && !emulated_device::are_apart(from, to, count * sizeof(T))))
            return cudaErrorInvalidValue;
        const std::size_t needed = 512 + count / 64 * (sizeof(T) + 4);
        return emulated_device::with_scratch(memory, bytes, needed, stream, [=] {
            T total = first;
            for (std::size_t i = 0; i < count; ++i) {
                const T own = from[i];
                to[i] = total;
                total = sum(total, own);
            }
        });
    }
};

}  // namespace cub
