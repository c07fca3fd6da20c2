// The bricks of one mesh, packed on the device.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <span>
#include <vector>

#include "codec/lattice/pack_bricks.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/device_mesh.hpp"
#include "meniscus/device_packed_frame.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/packed_bricks.hpp"
#include "pipeline/cuda_mesh_storage.hpp"

namespace meniscus::cuda {

/// A brick with triangles, as the device has it.
struct BrickOnDevice {
    std::uint32_t index = 0;  ///< of its KeptBrick
    KeptBrick kept;
};

/// A finished mesh on the device, from which a download copies.
struct MeshOnDevice {
    DeviceMesh mesh;
    const MeshBrick* bricks = nullptr;
    LatticeOnDevice lattice;           ///< no blocks where it is not kept
    std::uint32_t lattice_blocks = 0;  ///< number of its blocks
};

class DevicePackedBricks final : public PackedBricks {
public:
    /// Packs them and waits for it, with MeshStorage::copying held. The mesh may go then. mesh: has its bricks.
    /// options: valid for it. on_device: one for each brick. time: of the copies of bricks. Throws LimitExceeded where
    /// there is too little memory.
    DevicePackedBricks(std::shared_ptr<MeshStorage> storage, const MeshOnDevice& from, const Mesh& mesh,
                       std::span<const BrickOnDevice> on_device, const CodingOptions& options,
                       std::shared_ptr<CopyTime> time);
    ~DevicePackedBricks() override;

    /// Every brick, as DevicePackedFrame has it.
    std::vector<DevicePackedBrick> all() const;

    ContentHash hash(std::size_t brick) const override {
        return {bricks_[brick].hash.of[0], bricks_[brick].hash.of[1]};
    }
    DeviceBytes on_device(std::size_t brick) const override;
    void leave(std::size_t brick) override;
    EncodedBrick bring(std::size_t brick) override;

private:
    struct Brick {
        PackedPlace place;
        std::size_t bytes = 0;
        std::array<std::int32_t, 3> coordinate{};
        std::uint32_t vertices = 0, triangles = 0;
        WordHash hash{};
        bool is_left = false;
        bool is_here = false;
    };

    /// Bytes in a step: few enough at first for the first brick to be there soon, then twice as many from step to step.
    static constexpr std::size_t first_fetch_bytes = std::size_t{64} << 10;
    static constexpr std::size_t most_fetch_bytes = std::size_t{4} << 20;

    void pack(const MeshOnDevice& from, const Mesh& mesh, const CodingOptions& options, std::uint64_t words);
    void fetch_from(std::size_t first);
    void give_back() noexcept;

    const std::shared_ptr<MeshStorage> storage_;
    const std::shared_ptr<CopyTime> time_;
    std::unique_ptr<PackingMemory> memory_;
    std::vector<Brick> bricks_;
    // Guarded by MeshStorage::copying, as is_left and is_here are:
    std::exception_ptr error_;
    std::size_t fetch_bytes_ = first_fetch_bytes;
};

}  // namespace meniscus::cuda
