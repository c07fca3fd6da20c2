// Particles in, mesh out.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "meniscus/backend_options.hpp"
#include "meniscus/device_mesh.hpp"
#include "meniscus/device_packed_frame.hpp"
#include "meniscus/device_particles.hpp"
#include "meniscus/frame_upload.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/mesh_download.hpp"
#include "meniscus/part.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus {

/// Reconstructs the surface of particle frames, one after the other, and keeps its buffers between them.
/// One reconstructor is used by one thread at a time, send_ahead() aside; several may live side by side. Their frames
/// take turns on a GPU.
class Reconstructor {
public:
    /// Throws InvalidInput for settings or a number of threads out of range, and for a backend or processor that cannot
    /// be used, saying why.
    explicit Reconstructor(const Settings& settings, const BackendOptions& options = {});
    ~Reconstructor();
    Reconstructor(Reconstructor&&) noexcept;
    Reconstructor& operator=(Reconstructor&&) noexcept;

    /// Replaces `mesh`, reusing its memory. Its memory is charged to this reconstructor's account from the first call
    /// on. Throws InvalidInput (non-finite or too distant positions, lengths that do not match, levels above 3;
    /// attributes that are missing, not finite, or of another form than in the frames before) or LimitExceeded (memory,
    /// work), or Stopped (BackendOptions::stop); the mesh is then empty and the reconstructor remains usable. On a GPU
    /// also DeviceError. After InvalidInput the surface and the statistics of the frame before are there still.
    void reconstruct(const ParticleFrame& frame, Mesh& mesh);

    /// As reconstruct() and release_memory(), at a lower peak of memory: the CPU backend gives buffers back as soon as
    /// no later step needs them. For a frame that no other follows.
    void reconstruct_last(const ParticleFrame& frame, Mesh& mesh);

    /// As reconstruct(), of a part of a frame. frame: all of the whole's particles that lie within reach_of() the part,
    /// or more. The mesh, its attributes, its spray and the statistics are those of the part's own bricks: once no seam
    /// differs from that of the part beyond it, they are what reconstruct() gives these bricks in the whole frame, to
    /// the bit. Vertices on a border are part of the meshes on both sides of it. A mesh is open at the border. Nothing
    /// is warned of. A limit of work holds for the part. Also throws InvalidInput for a box that is empty or beyond
    /// all_bricks, for an overlap and for ranges out of range.
    PartOutcome reconstruct_part(const ParticleFrame& frame, const FramePart& part, Mesh& mesh);

    /// As reconstruct(), but returns once the mesh is finished in the memory in which it was made. From a GPU the
    /// download then copies it, in the caller's thread or another, while the next frame is reconstructed. Two meshes
    /// may wait on the GPU: a third frame, or one for which the device's memory limit leaves no room for a second mesh,
    /// first downloads the earlier one.
    [[nodiscard]] MeshDownload reconstruct_for_download(const ParticleFrame& frame, Mesh& mesh);

    /// Begins to copy the next frame's particles to the GPU while the frame before is reconstructed, by another thread
    /// if need be: the only call for two threads at a time. ParticleFrame::sent then hands it to the reconstruction,
    /// and nothing is copied there. Only a frame whose arrays all lie in pinned memory is sent, one at a time, and none
    /// before a frame of its size; nowhere else than on a GPU. Where none is sent, the reconstruction does as it would
    /// have: so the result may be ignored.
    [[nodiscard]] FrameUpload send_ahead(const ParticleFrame& frame) noexcept;

    /// As reconstruct(), but the mesh stays on the GPU. Throws InvalidInput on the CPU backend.
    DeviceMesh reconstruct_on_device(const ParticleFrame& frame);

    /// The same three for particles that are on the GPU already: they are checked and copied there, and never come
    /// down. Throw InvalidInput as reconstruct() does, with the same messages; also for arrays that do not lie on this
    /// reconstructor's GPU, and on the CPU backend.
    void reconstruct(const DeviceParticleFrame& frame, Mesh& mesh);
    [[nodiscard]] MeshDownload reconstruct_for_download(const DeviceParticleFrame& frame, Mesh& mesh);
    DeviceMesh reconstruct_on_device(const DeviceParticleFrame& frame);

    /// After reconstruct_on_device(): that mesh as bricks of the profile lattice_packed, packed where it lies. After
    /// another call the same of its mesh. options: normal_bits and position_bits alone. wishes: what the bricks have of
    /// the attributes. Throws InvalidInput for options out of range, without a surface, without
    /// BackendOptions::keep_lattice and on the CPU backend; LimitExceeded where the GPU's memory limit leaves no room,
    /// and DeviceError, which leave the surface as it is.
    DevicePackedFrame pack_on_device(const CodingOptions& options = {}, std::span<const AttributeWish> wishes = {});

    /// Emits the last frame's surface once more with no cell finer than max_level (1 to 3). The result is coarser, has
    /// fewer triangles, and is closed as well. The call is cheap: nothing is sampled, and only the steps from
    /// count_triangles on run. The statistics do not change. Throws InvalidInput for another max_level, and if the last
    /// valid frame did not end with a surface; else as reconstruct() does. The last frame's own mesh may still be
    /// downloaded to another Mesh; an earlier mesh that waits on the GPU is then downloaded first.
    void emit_capped(int max_level, Mesh& mesh);

    /// Gives the buffers back; the next frame takes them again. There is no surface to emit again until then. Meshes
    /// keep their memory.
    void release_memory();

    /// Replaces BackendOptions::memory_limit (bytes; 0: none) from the next call on. Buffers that are there stay, also
    /// where they are larger.
    void limit_memory(std::size_t bytes);

    /// The statistics of the last frame.
    const Statistics& statistics() const;
    const Settings& settings() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

/// Throws InvalidInput if the frame's arrays do not fit each other, a position is not finite or lies beyond what
/// the lattice can address, or a level is above 3; names the particle, the value and the limit. So it does, with the
/// array's name, if one that the settings name among the attributes is missing, comes twice, cannot be an attribute or
/// has a value that is not finite. A frame without particles may lack it.
void validate(const ParticleFrame& frame, const Settings& settings);
/// The first of these alone, which looks at no particle. Throws InvalidInput, and LimitExceeded for too many arrays or
/// particles.
void validate_lengths(const ParticleFrame& frame);

/// The backend that a choice comes to on this machine.
struct BackendDescription {
    Backend backend = Backend::cpu;
    std::string name;    ///< "cpu" or "cuda"
    std::string device;  ///< name of the processor or GPU
    std::string reason;  ///< why this backend, in one line
};
/// choice: Backend::automatic takes the GPU if it can be used. device: index of that GPU. Throws InvalidInput for
/// Backend::cuda without a GPU that can be used, and where MENISCUS_INSTRUCTIONS names a set that cannot be used.
BackendDescription describe_backend(Backend choice, int device = 0);

/// This library's version, "major.minor.patch".
std::string_view version();

}  // namespace meniscus
