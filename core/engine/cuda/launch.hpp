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

/// The number of multiprocessors of a device.
inline unsigned processors_of(int device) {
    int processors = 0;
    check(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device), "cudaDeviceGetAttribute");
    return static_cast<unsigned>(std::max(1, processors));
}

/// Launches kernels on a stream.
struct Launcher {
    cudaStream_t stream = nullptr;
    unsigned processors = 1;        ///< multiprocessors of the stream's device
    unsigned most_cooperative = 0;  ///< see most_cooperative_blocks()

    /// Launches a kernel for up to `elements` elements, `a_block` of them in a block at a time.
    template <class... Parameters, class... Arguments>
    void operator()(std::uint64_t elements, unsigned a_block, void (*kernel)(Parameters...),
                    const Arguments&... arguments) const {
        // Whole waves, of which none leaves the device half empty: some eight blocks a multiprocessor, so that elements
        // that take long are evened out.
        const unsigned at_once = blocks_of_processor(kernel);
        const unsigned waves = std::max(1U, (8 + at_once / 2) / at_once);
        launch(blocks_for(elements, a_block, std::uint64_t{processors} * at_once * waves), false, kernel, arguments...);
    }
    /// Launches a kernel with a block for each element: where they take differently long, the next begins as soon as
    /// one has ended.
    template <class... Parameters, class... Arguments>
    void each(std::uint64_t elements, void (*kernel)(Parameters...), const Arguments&... arguments) const {
        constexpr std::uint64_t largest_grid = 0x7FFF'FFFF;
        launch(blocks_for(elements, 1, largest_grid), false, kernel, arguments...);
    }
    /// Launches a kernel for up to `elements` elements, with no more blocks than run at once, so that it can wait for
    /// its whole grid.
    template <class... Parameters, class... Arguments>
    void cooperative(std::uint64_t elements, void (*kernel)(Parameters...), const Arguments&... arguments) const {
        std::uint64_t most = std::uint64_t{processors} * blocks_of_processor(kernel);
        if (most_cooperative != 0) most = std::min<std::uint64_t>(most, most_cooperative);
        launch(blocks_for(elements, block_threads, most), true, kernel, arguments...);
    }

    /// Asks for as much of a multiprocessor's memory as can be shared memory, of which this kernel's blocks use most:
    /// else the driver guesses how many of them shall have room.
    template <class... Parameters>
    void prefer_shared_memory(void (*kernel)(Parameters...)) const {
        check(cudaFuncSetAttribute(reinterpret_cast<const void*>(kernel),
                                   cudaFuncAttributePreferredSharedMemoryCarveout, cudaSharedmemCarveoutMaxShared),
              "cudaFuncSetAttribute");
    }

    /// Number of threads of a kernel that run at once on the whole device.
    template <class... Parameters>
    std::uint64_t threads_at_once(void (*kernel)(Parameters...)) const {
        return std::uint64_t{processors} * blocks_of_processor(kernel) * block_threads;
    }

private:
    /// Number of blocks of a kernel that run at once on a multiprocessor. One where none would fit: CUDA then names the
    /// resource that is lacking.
    template <class... Parameters>
    static unsigned blocks_of_processor(void (*kernel)(Parameters...)) {
        int blocks = 0;
        check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, static_cast<int>(block_threads), 0),
              "cudaOccupancyMaxActiveBlocksPerMultiprocessor");
        return static_cast<unsigned>(std::max(1, blocks));
    }
    static unsigned blocks_for(std::uint64_t elements, unsigned a_block, std::uint64_t most) {
        return static_cast<unsigned>(std::clamp<std::uint64_t>((elements + a_block - 1) / a_block, 1, most));
    }
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
