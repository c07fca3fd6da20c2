// A finished mesh on its way from the GPU, while the next frame is reconstructed there.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

namespace meniscus {

/// Fills the Mesh that Reconstructor::reconstruct_for_download() was given. That mesh must stay where it is, untouched,
/// until this is finished or destroyed; destroying it leaves a mesh that is not complete, and gives the GPU's memory
/// back to later frames.
///
/// What is asked for comes down in the caller's thread; several threads may ask. All but seconds() throw DeviceError if
/// the GPU fails, then and ever after. The reconstructor may end first, or refuse a frame: what is not there yet comes
/// down then.
class MeshDownload {
public:
    /// What a backend does for it. Thread-safe.
    class Source {
    public:
        virtual ~Source() = default;
        virtual void start() = 0;
        virtual void bring(std::size_t brick) = 0;
        virtual void finish() = 0;
        /// The mesh may go: nothing is written to it any more.
        virtual void abandon() noexcept = 0;
        virtual double seconds() const = 0;
    };

    /// Of a mesh that is complete already, as the CPU's are.
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

    /// Vertices, normals and bricks are there; triangles have their number.
    void start() const {
        if (source_) source_->start();
    }
    /// And so are the triangles of Mesh::bricks[brick].
    void bring(std::size_t brick) const {
        if (source_) source_->bring(brick);
    }
    /// The mesh is complete.
    void finish() const {
        if (source_) source_->finish();
    }
    /// Wall time that the copying has taken so far.
    double seconds() const { return source_ ? source_->seconds() : 0.0; }

private:
    std::shared_ptr<Source> source_;
};

}  // namespace meniscus
