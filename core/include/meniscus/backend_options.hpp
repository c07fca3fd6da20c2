// The place where a reconstruction runs, and the resources that it may take there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "meniscus/described.hpp"
#include "meniscus/memory.hpp"
#include "meniscus/stop_flag.hpp"

namespace meniscus {

enum class Backend : std::uint8_t {
    automatic,  ///< a GPU if one can be used, else the CPU
    cpu,
    cuda,
};
constexpr std::string_view name_of(Backend backend) {
    switch (backend) {
        case Backend::automatic:
            return "auto";
        case Backend::cpu:
            return "cpu";
        case Backend::cuda:
            return "cuda";
    }
    return {};
}

/// Most worker threads of one reconstructor. More than processors are no faster.
inline constexpr unsigned max_threads = 1024;

struct BackendOptions {
    Backend backend = Backend::automatic;
    unsigned threads = 0;                 ///< CPU worker threads, at most max_threads; 0: one per processor
    std::size_t memory_limit = 0;         ///< bytes one reconstructor may hold; 0: no limit of its own
    int device = 0;                       ///< index of the GPU, see devices.hpp
    std::size_t device_memory_limit = 0;  ///< bytes one reconstructor may hold on the GPU; 0: no limit of its own
    /// The most work of a frame, as a multiple of that of as many particles that are evenly spread
    /// (core/README.md#work-20-and-1024); a frame beyond it is refused with LimitExceeded. 0: no limit.
    double work_limit = 0.0;
    /// Whether meshes come with Mesh::lattice, which the lattice codecs need, and can be packed on a GPU.
    bool keep_lattice = false;
    std::shared_ptr<const StopFlag> stop = {};             ///< ends a reconstruction with Stopped; none: nothing does
    std::shared_ptr<SharedMemory> shared_memory{};         ///< shared by all reconstructors; may be null
    std::shared_ptr<SharedMemory> shared_device_memory{};  ///< shared by all on that GPU; may be null
    /// Pins the arrays into which meshes come down from a GPU. Null: a page_pinning() of the reconstructor's own.
    std::shared_ptr<PagePinning> pinning{};
    /// Called, once in a reconstruction's life, where a GPU must do without something that makes it faster, with what
    /// and why. Meshes are the same. None: nobody is told.
    std::function<void(const std::string& what)> notice{};

    /// Those that C, Python and files set by name.
    template <class Visit>
    static void rows(const Visit& visit) {
        using B = BackendOptions;
        visit("backend", &B::backend, {.help = "where a reconstruction runs"});
        visit("threads", &B::threads, {.help = "worker threads; 0: one per processor"});
        visit("memory_limit", &B::memory_limit, {.help = "memory of the reconstruction; 0: no limit", .unit = "bytes"});
        visit("device", &B::device, {.help = "index of the GPU"});
        visit("device_memory_limit", &B::device_memory_limit,
              {.help = "memory of the reconstruction on its GPU; 0: no limit", .unit = "bytes"});
        visit("keep_lattice", &B::keep_lattice,
              {.help = "whether meshes keep what their bricks are made of, so that they can be published"});
    }
};

}  // namespace meniscus
