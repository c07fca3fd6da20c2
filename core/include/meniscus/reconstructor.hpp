// Particles in, mesh out.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "meniscus/backend_options.hpp"
#include "meniscus/device_mesh.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/mesh_download.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus {

/// Reconstructs the surface of particle frames, one after the other, and keeps its buffers between them.
/// One reconstructor is used by one thread at a time; several may live side by side.
class Reconstructor {
public:
    /// Throws InvalidInput for settings out of range, and for a backend or processor that cannot be used, saying why.
    explicit Reconstructor(const Settings& settings, const BackendOptions& options = {});
    ~Reconstructor();
    Reconstructor(Reconstructor&&) noexcept;
    Reconstructor& operator=(Reconstructor&&) noexcept;

    /// Replaces `mesh`, reusing its memory. Its memory is charged to this reconstructor's account from the first call
    /// on. Throws InvalidInput (non-finite or too distant positions, lengths that do not match, levels above 3) or
    /// LimitExceeded (memory); the mesh is then empty and the reconstructor remains usable. On a GPU also DeviceError.
    void reconstruct(const ParticleFrame& frame, Mesh& mesh);

    /// The same, but returns once the mesh is finished where it was made; on a GPU it comes down as the caller, or
    /// another thread, asks for it, while this one goes on to the next frame. Two meshes may be on their way: a third
    /// frame, or one for which the device's memory limit leaves no second mesh, first brings the earlier one down.
    [[nodiscard]] MeshDownload reconstruct_for_download(const ParticleFrame& frame, Mesh& mesh);

    /// The same, but the mesh stays on the GPU. Throws InvalidInput on the CPU backend.
    DeviceMesh reconstruct_on_device(const ParticleFrame& frame);

    /// Emits the last frame's surface once more with no cell finer than max_level (1 to 3): coarser, with fewer
    /// triangles, and closed as ever. Cheap, since nothing is sampled: only the steps from count_triangles on run.
    /// Leaves the statistics as they are. Throws InvalidInput for another max_level, or if the last call did not end
    /// with a surface; else as reconstruct() does. The last frame's own mesh may still be on its way, to another Mesh;
    /// then this first brings an earlier mesh that is still on its way down.
    void emit_capped(int max_level, Mesh& mesh);

    /// Of the last frame.
    const Statistics& statistics() const;
    const Settings& settings() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

/// Throws InvalidInput if the frame's arrays do not fit each other, a position is not finite or lies beyond what
/// the lattice can address, or a level is above 3; names the particle, the value and the limit.
void validate(const ParticleFrame& frame, const Settings& settings);

/// "cpu" or "cuda" for what `automatic` picks here, and in one line why.
struct BackendDescription {
    Backend backend = Backend::cpu;
    std::string name;    ///< "cpu" or "cuda"
    std::string device;  ///< processor or GPU, in words
    std::string reason;  ///< why this one
};
/// device: the GPU asked for.
BackendDescription describe_backend(Backend choice, int device = 0);

/// This library's version, "major.minor.patch".
std::string_view version();

}  // namespace meniscus
