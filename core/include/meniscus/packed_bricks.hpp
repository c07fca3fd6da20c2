// Bricks that a GPU has packed, on their way down one by one.
#pragma once

#include <cstddef>

#include "meniscus/brick_coding.hpp"

namespace meniscus {

/// A brick's bytes on the GPU.
struct DeviceBytes {
    const std::byte* data = nullptr;  ///< device pointer
    std::size_t size = 0;
    int device = 0;  ///< index of the GPU
};

/// The bricks of a mesh in the profile lattice_packed, byte for byte as the CPU packs them. A brick is named by its
/// index in Mesh::bricks. Thread-safe. It may outlive the download that it comes from.
class PackedBricks {
public:
    virtual ~PackedBricks() = default;
    /// Equal for equal content packed with the same options. It is not PreparedBrick's hash of that content.
    virtual ContentHash hash(std::size_t brick) const = 0;
    /// The brick's bytes where they were packed, complete on every stream, and there as long as this is: for a caller
    /// that sends them on from the GPU.
    virtual DeviceBytes on_device(std::size_t brick) const = 0;
    /// Leaves a brick out: it comes down only if bring() asks for it.
    virtual void leave(std::size_t brick) = 0;
    /// Copies the brick to the host, in the caller's thread, with some of those after it. Throws DeviceError if the GPU
    /// fails, and again at every later call.
    virtual EncodedBrick bring(std::size_t brick) = 0;
};

}  // namespace meniscus
