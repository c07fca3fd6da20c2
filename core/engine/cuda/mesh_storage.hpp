// Where finished meshes lie until they have been downloaded.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>

#include "engine/cuda/array_memory.hpp"
#include "engine/cuda/download.hpp"
#include "engine/cuda/errors.hpp"
#include "engine/cuda/stream.hpp"

namespace meniscus::cuda {

/// Two sets of mesh arrays, so that one is written while the other is read, and what copies from them. It lives as long
/// as the reconstruction or a download refers to it; the sets are freed when the reconstruction ends. The kernels'
/// stream never meets this one: the host waits for the kernels before a download begins, and for the copies before the
/// arrays are written again.
struct MeshStorage {
    MeshStorage(int on_device, const std::shared_ptr<MemoryAccount>& account,
                const std::shared_ptr<MemoryAccount>& device_account)
        : device(on_device),
          download(account),
          sets{{{on_device, stream.get(), device_account}, {on_device, stream.get(), device_account}}} {}
    ~MeshStorage() {
        try {
            at_end.emplace(device);
        } catch (...) {
            // The device is lost: there is nothing to free on it.
        }
    }
    MeshStorage(const MeshStorage&) = delete;
    MeshStorage& operator=(const MeshStorage&) = delete;

    int device;
    std::optional<CurrentDevice> at_end;  ///< makes the device current while the members below end, in any thread
    std::mutex copying;                   ///< held by the thread that copies
    Download download;                    ///< its pinned memory outlives the stream, whose end waits for the copies
    Stream stream;
    std::array<ArrayMemory, 2> sets;  ///< see State::mesh_arrays()
};

}  // namespace meniscus::cuda
