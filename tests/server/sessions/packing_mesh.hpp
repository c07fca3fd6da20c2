// A mesh that is packed where it lies, as by a GPU: made on the CPU, of which nothing comes down but the bricks.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "meniscus/brick_coding.hpp"
#include "meniscus/mesh_download.hpp"
#include "meniscus/packed_bricks.hpp"

namespace meniscus::server::test {

/// The requests that the mesh has had.
struct AskedFor {
    int meshes = 0;
    std::vector<std::size_t> bricks;
};

class PackingMesh final : public MeshDownload::Source {
public:
    /// to: complete, with its lattice; of it the sizes alone stay until it comes down.
    PackingMesh(std::shared_ptr<AskedFor> asked_for, Mesh& to)
        : asked_for_(std::move(asked_for)), made_(std::make_shared<const Mesh>(to)), to_(to) {
        to_.bricks.clear();
        to_.lattice = {};
    }

    void start() override {
        ++asked_for_->meshes;
        to_ = *made_;
    }
    void bring(std::size_t) override {}
    void finish() override { start(); }
    std::shared_ptr<PackedBricks> pack(const CodingOptions& options) override {
        to_.bricks = made_->bricks;
        CodingOptions packed = options;
        packed.codec = Codec::lattice_packed;
        return std::make_shared<Bricks>(asked_for_, made_, packed);
    }
    std::vector<AttributeRange> attribute_ranges() override { return meniscus::attribute_ranges(*made_); }
    void abandon() noexcept override {}
    double seconds() const override { return 0.0; }

private:
    class Bricks final : public PackedBricks {
    public:
        Bricks(std::shared_ptr<AskedFor> asked_for, std::shared_ptr<const Mesh> mesh, CodingOptions options)
            : asked_for_(std::move(asked_for)), mesh_(std::move(mesh)), options_(std::move(options)) {}
        ContentHash hash(std::size_t brick) const override {
            BrickScratch scratch;
            return PreparedBrick(*mesh_, brick, options_, scratch).hash();
        }
        DeviceBytes on_device(std::size_t) const override { return {}; }
        void leave(std::size_t) override {}
        EncodedBrick bring(std::size_t brick) override {
            asked_for_->bricks.push_back(brick);
            return encode_brick(*mesh_, brick, options_);
        }

    private:
        const std::shared_ptr<AskedFor> asked_for_;
        const std::shared_ptr<const Mesh> mesh_;
        const CodingOptions options_;
    };

    const std::shared_ptr<AskedFor> asked_for_;
    const std::shared_ptr<const Mesh> made_;
    Mesh& to_;
};

}  // namespace meniscus::server::test
