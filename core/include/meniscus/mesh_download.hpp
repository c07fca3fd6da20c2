// A finished mesh on its way from the GPU, while the next frame is reconstructed there.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/brick_coding.hpp"
#include "meniscus/packed_bricks.hpp"

namespace meniscus {

/// Fills the Mesh that was passed to Reconstructor::reconstruct_for_download(). That mesh must neither move nor change
/// until the download is finished or destroyed. Destroying it leaves an incomplete mesh, and gives the GPU's memory
/// back to later frames.
///
/// All calls work in the caller's thread; several threads may call them. They throw DeviceError if the GPU fails, and
/// again at every later call. If the reconstructor ends or refuses a frame first, the rest of the mesh is copied then.
class MeshDownload {
public:
    /// The backend's side of a download. Thread-safe. After each call the mesh holds what MeshDownload's function of
    /// that name promises.
    class Source {
    public:
        virtual ~Source() = default;
        virtual void start() = 0;
        virtual void bring(std::size_t brick) = 0;
        virtual void finish() = 0;
        virtual std::shared_ptr<PackedBricks> pack(const CodingOptions& options) = 0;
        virtual std::vector<AttributeRange> attribute_ranges() = 0;
        /// From here on nothing is written to the mesh, which may be destroyed.
        virtual void abandon() noexcept = 0;
        virtual double seconds() const = 0;
    };

    /// The download of a mesh that is complete already, as every mesh of the CPU is.
    MeshDownload() = default;
    explicit MeshDownload(std::shared_ptr<Source> source) : source_(std::move(source)) {}
    ~MeshDownload() {
        if (source_) source_->abandon();
    }
    MeshDownload(MeshDownload&& other) noexcept : source_(std::move(other.source_)) {}
    MeshDownload& operator=(MeshDownload&& other) noexcept {
        MeshDownload old(std::exchange(source_, std::move(other.source_)));
        return *this;
    }
    MeshDownload(const MeshDownload&) = delete;
    MeshDownload& operator=(const MeshDownload&) = delete;

    /// For a lattice codec: packs the bricks of `mesh`, to which this download belongs, where they lie. After it the
    /// mesh has its bricks; nothing else of it has come down. None where the host must encode them from the mesh: one
    /// of the CPU, one that has come down, one without its lattice (BackendOptions::keep_lattice), and where the GPU's
    /// memory limit leaves no room. Throws InvalidInput as PreparedBrick does.
    std::shared_ptr<PackedBricks> pack(const Mesh& mesh, const CodingOptions& options) const;
    /// attribute_ranges(mesh) of that mesh, wherever its vertices are.
    std::vector<AttributeRange> attribute_ranges(const Mesh& mesh) const {
        return source_ ? source_->attribute_ranges() : meniscus::attribute_ranges(mesh);
    }
    /// After start(), the mesh has its vertices, normals, attributes, bricks and lattice. Its array of triangles has
    /// the final size, but no content yet. Spray is there from the beginning.
    void start() const {
        if (source_) source_->start();
    }
    /// After start() and bring(i), the mesh also has the triangles of Mesh::bricks[i].
    void bring(std::size_t brick) const {
        if (source_) source_->bring(brick);
    }
    /// After finish(), the mesh is complete.
    void finish() const {
        if (source_) source_->finish();
    }
    /// Wall time of the copies so far.
    double seconds() const { return source_ ? source_->seconds() : 0.0; }

private:
    std::shared_ptr<Source> source_;
};

}  // namespace meniscus
