// The demands of CUB on its callers, checked at every call: as much scratch memory as it has named for as many
// elements, and arrays that either are the same or do not touch. Its work waits in the stream as a kernel does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include "cuda_runtime.h"

namespace emulated_device {

/// Whether two arrays of these many bytes have none in common.
inline bool are_apart(const void* a, const void* b, std::size_t bytes) {
    const auto* const x = static_cast<const std::byte*>(a);
    const auto* const y = static_cast<const std::byte*>(b);
    return x + bytes <= y || y + bytes <= x;
}

/// Without memory: names the bytes that `n` elements need. With it: puts the work on the stream, where all of these
/// bytes are written before it.
template <class Work>
cudaError_t with_scratch(void* memory, std::size_t& bytes, std::size_t needed, cudaStream_t stream, Work work) {
    if (memory == nullptr) {
        bytes = needed;
        return cudaSuccess;
    }
    if (bytes < needed) return cudaErrorInvalidValue;
    submit(stream, [=, run = std::move(work)] {
        std::memset(memory, 0x5A, needed);
        run();
    });
    return cudaSuccess;
}

}  // namespace emulated_device
