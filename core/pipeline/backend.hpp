// The interface of a backend for the reconstructor: the CPU's and CUDA's stand beside it.
#pragma once

#include <memory>
#include <span>

#include "base/instruction_set.hpp"
#include "meniscus/backend_options.hpp"
#include "meniscus/device_mesh.hpp"
#include "meniscus/device_packed_frame.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/mesh_download.hpp"
#include "meniscus/part.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"
#include "meniscus/statistics.hpp"
#include "particles/frame_sender.hpp"
#include "particles/placed_frame.hpp"

namespace meniscus {

class BackendReconstruction {
public:
    virtual ~BackendReconstruction() = default;
    /// The frame is valid. Throws Stopped where BackendOptions::stop is raised; after that, and after a refusal for its
    /// work, the next frame may follow. Fills every figure of the statistics but memory and times of the whole. The
    /// mesh has its final sizes, bricks aside; its content is there once it has been downloaded.
    /// It comes with the attributes of the frame, without values.
    virtual MeshDownload reconstruct(const PlacedFrame& particles, Mesh& mesh, Statistics& statistics) = 0;
    /// The surface of the last frame once more, with no cell finer than max_level (1 to 3).
    virtual void emit_capped(int max_level, Mesh& mesh) = 0;
    /// Of the last frame, which was a part of one.
    virtual PartOutcome part_outcome() = 0;
    /// The greatest value of the field at the points that the last frame had sampled, inside the domain; 0 without any.
    virtual float greatest_sample() = 0;
    /// As reconstruct(), but the mesh stays where it is until the next call. Of its attributes only the data are set.
    virtual DeviceMesh reconstruct_on_device(const PlacedFrame&, Statistics&) {
        throw InvalidInput("the CPU backend has no mesh on a GPU: use reconstruct(), or the backend cuda");
    }
    /// Packs the last mesh where it lies. mesh: empty, with what all meshes of the frame have: its lattice, and the
    /// forms of its attributes; options: in range for it. Fills the bricks of `packed`, their memory and attributes.
    virtual void pack_on_device(Mesh&, const CodingOptions&, std::span<const AttributeWish>, DevicePackedFrame&) {
        throw InvalidInput("the CPU backend packs no bricks on a GPU: use encode_brick(), or the backend cuda");
    }
    /// validate() for a frame whose lengths are valid and whose arrays are device pointers, once what is on `stream`
    /// (a cudaStream_t) is done. Changes nothing. The frame may then be reconstructed.
    virtual ParticlesByLevel validate_on_device(const ParticleFrame&, void* /*stream*/, const Settings&) {
        throw InvalidInput(
            "the CPU backend takes no particles from a GPU: copy them to host memory, or use the backend cuda");
    }
    /// The sender of frames ahead, which may outlive this backend; none on the CPU, where there is no place to send
    /// them.
    virtual std::shared_ptr<FrameSender> sender() { return nullptr; }
    /// After validate_on_device(): the numbers of the frame's arrays, which can be attributes. Throws InvalidInput,
    /// with the words of numbers_in_host_memory(), for a value that is not finite.
    virtual AttributeNumbers numbers_on_device(const ParticleFrame& frame) { return attribute_numbers(frame.arrays); }
};

namespace cpu {
/// The CPU backend with the loops for one instruction set, which the processor has.
template <InstructionSet>
std::unique_ptr<BackendReconstruction> make_reconstruction(const Settings& settings, const BackendOptions& options,
                                                           const std::shared_ptr<MemoryAccount>& account);
/// The CPU backend with the loops of chosen_instruction_set().
std::unique_ptr<BackendReconstruction> make_reconstruction(const Settings& settings, const BackendOptions& options,
                                                           const std::shared_ptr<MemoryAccount>& account);
}  // namespace cpu

namespace cuda {
/// device_account: charged for the memory on the GPU. Throws DeviceError if the device does not answer.
std::unique_ptr<BackendReconstruction> make_reconstruction(const Settings& settings, const BackendOptions& options,
                                                           const std::shared_ptr<MemoryAccount>& account,
                                                           const std::shared_ptr<MemoryAccount>& device_account);
}  // namespace cuda

}  // namespace meniscus
