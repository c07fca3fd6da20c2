// Validation of particles that a caller has on the device: by a kernel, so that they need not come down.
#pragma once

#include <memory>
#include <string>

#include "engine/cuda/device_memory.hpp"
#include "engine/cuda/launch.hpp"
#include "engine/cuda/pinned_memory.hpp"
#include "engine/cuda/state.hpp"
#include "engine/cuda/stream.hpp"
#include "meniscus/attribute_coding.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"
#include "particles/placed_frame.hpp"

namespace meniscus::cuda {

/// The kernel's findings. Zero at its begin, and where it finds nothing: of two findings the greater is kept.
struct ParticleFindings {
    Counter first_bad;  ///< index of the first coordinate that is not finite or too far, bits inverted
    Counter coarsest;   ///< the greatest level, and in the lower bits the first particle that has it, inverted
    Counter by_level[max_particle_level + 1];
};

/// The same for the values of an array; see ordered_bits().
struct ValueFindings {
    Counter first_bad;  ///< index of the first value that is not finite, bits inverted
    Counter greatest[max_attribute_components];
    Counter least[max_attribute_components];  ///< least value of each component, bits inverted
};

class ParticleCheck {
public:
    /// Runs on the launcher's stream.
    ParticleCheck(int device, const Launcher& launch, const std::shared_ptr<MemoryAccount>& account,
                  const std::shared_ptr<MemoryAccount>& device_account);

    /// frame: of device pointers, its lengths are valid. Waits for the work on `made_on`, and makes its own stream wait
    /// for it, too. Throws InvalidInput with the messages of validate(), and for pointers to other memory.
    ParticlesByLevel require_valid(const ParticleFrame& frame, cudaStream_t made_on, const Settings& settings);
    /// The numbers of a valid frame, see BackendReconstruction::numbers_on_device().
    AttributeNumbers find_numbers(const ParticleFrame& frame);

private:
    ValueFindings look_at(const ParticleArray& array, std::uint32_t particles);
    void require_on_device(const void* array, const std::string& name) const;
    float value_at(const float* on_device);
    /// Waits for the findings.
    void wait();

    int device_;
    Launcher launch_;
    PinnedMemory on_host_;
    Event made_;
    AwaitedEvent found_;
    DeviceMemory on_device_;
};

}  // namespace meniscus::cuda
