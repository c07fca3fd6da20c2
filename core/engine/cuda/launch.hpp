// Kernel launches: 256 threads a block, and loops over all elements whatever the number of blocks.
#pragma once

#include <algorithm>
#include <cstdint>

#include "engine/cuda/errors.hpp"
#include "engine/cuda/launch_observer.hpp"

namespace meniscus::cuda {

inline constexpr unsigned block_threads = 256;
inline constexpr unsigned warp_threads = 32;
inline constexpr unsigned block_warps = block_threads / warp_threads;

/// Where kernels run, and how many blocks keep the device busy.
struct Launcher {
    cudaStream_t stream = nullptr;
    unsigned most_blocks = 1;

    /// For up to `elements` elements with `a_block` of them in a block at a time.
    template <class... Parameters, class... Arguments>
    void operator()(std::uint64_t elements, unsigned a_block, void (*kernel)(Parameters...),
                    const Arguments&... arguments) const {
        const std::uint64_t blocks = std::clamp<std::uint64_t>((elements + a_block - 1) / a_block, 1, most_blocks);
        launch(static_cast<unsigned>(blocks), false, kernel, arguments...);
    }
    /// For up to `elements` elements, with no more blocks than run at once, so that a kernel can wait for its whole
    /// grid.
    template <class... Parameters, class... Arguments>
    void cooperative(std::uint64_t elements, void (*kernel)(Parameters...), const Arguments&... arguments) const {
        int a_processor = 0;
        int processors = 0;
        int device = 0;
        check(cudaGetDevice(&device), "cudaGetDevice");
        check(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device), "cudaDeviceGetAttribute");
        check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&a_processor, kernel, static_cast<int>(block_threads), 0),
              "cudaOccupancyMaxActiveBlocksPerMultiprocessor");
        // None would fit: one is tried, and CUDA names what it lacks.
        const std::uint64_t most = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(processors * a_processor));
        const std::uint64_t blocks = std::clamp<std::uint64_t>((elements + block_threads - 1) / block_threads, 1, most);
        launch(static_cast<unsigned>(blocks), true, kernel, arguments...);
    }

private:
    template <class... Parameters, class... Arguments>
    void launch(unsigned blocks, bool together, void (*kernel)(Parameters...), const Arguments&... arguments) const {
        cudaLaunchAttribute attribute{};
        attribute.id = cudaLaunchAttributeCooperative;
        attribute.val.cooperative = 1;
        cudaLaunchConfig_t configuration{};
        configuration.gridDim = dim3(blocks);
        configuration.blockDim = dim3(block_threads);
        configuration.stream = stream;
        configuration.attrs = &attribute;
        configuration.numAttrs = together ? 1 : 0;
        const ObservedLaunch observed({.stream = stream,
                                       .kernel = reinterpret_cast<const void*>(kernel),
                                       .blocks = blocks,
                                       .is_cooperative = together});
        check(cudaLaunchKernelEx(&configuration, kernel, arguments...), "cudaLaunchKernelEx");
    }
};

}  // namespace meniscus::cuda
