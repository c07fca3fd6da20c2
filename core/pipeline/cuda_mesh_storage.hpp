// Where finished meshes lie until they have been downloaded.
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "engine/cuda/array_memory.hpp"
#include "engine/cuda/download.hpp"
#include "engine/cuda/errors.hpp"
#include "engine/cuda/launch.hpp"
#include "engine/cuda/stream.hpp"
#include "pipeline/cuda_packing_memory.hpp"

namespace meniscus::cuda {

/// The wall time that a mesh takes on its way down, whoever asks for which part. With MeshStorage::copying held.
struct CopyTime {
    /// Adds its own life.
    class Span {
    public:
        explicit Span(CopyTime& time) : time_(time) {}
        ~Span() { time_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
        Span(const Span&) = delete;
        Span& operator=(const Span&) = delete;

    private:
        CopyTime& time_;
        std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    };
    double seconds = 0.0;
};

/// Two sets of mesh arrays, so that one is written while the other is read, and what copies from them. It lives as long
/// as the reconstruction or a download refers to it; the sets are freed when the reconstruction ends. The kernels'
/// stream never meets this one: the host waits for the kernels before a download begins, and for the copies before the
/// arrays are written again.
struct MeshStorage {
    MeshStorage(int on_device, const std::shared_ptr<MemoryAccount>& on_host,
                const std::shared_ptr<MemoryAccount>& account_on_device)
        : device(on_device),
          account(on_host),
          device_account(account_on_device),
          download(account),
          launch{stream.get(), processors_of(device)},
          sets{{{device, stream.get(), device_account}, {device, stream.get(), device_account}}} {}
    ~MeshStorage() {
        try {
            at_end.emplace(device);
        } catch (...) {
            // The device is lost: there is nothing to free on it.
        }
    }
    MeshStorage(const MeshStorage&) = delete;
    MeshStorage& operator=(const MeshStorage&) = delete;

    /// Memory to pack a mesh in, as it was given back, or new. With `copying` held.
    std::unique_ptr<PackingMemory> packing_memory() {
        if (to_pack_in.empty()) return std::make_unique<PackingMemory>(device, stream.get(), account, device_account);
        auto memory = std::move(to_pack_in.back());
        to_pack_in.pop_back();
        return memory;
    }

    int device;
    std::shared_ptr<MemoryAccount> account, device_account;
    std::optional<CurrentDevice> at_end;  ///< makes the device current while the members below end, in any thread
    std::mutex copying;                   ///< held by the thread that copies
    Download download;                    ///< its pinned memory outlives the stream, whose end waits for the copies
    Stream stream;
    Launcher launch;                                         ///< on that stream
    std::array<ArrayMemory, 2> sets;                         ///< see State::mesh_arrays()
    std::vector<std::unique_ptr<PackingMemory>> to_pack_in;  ///< that nobody uses now
};

}  // namespace meniscus::cuda
