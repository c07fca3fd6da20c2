// The particles of a part, of the messages in which each process sends those near it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "meniscus/particle_frame.hpp"
#include "meniscus/parts.hpp"
#include "meniscus/settings.hpp"

namespace meniscus {

/// What a frame's arrays have in common in all processes.
struct FrameForm {
    bool is_quantized = false;
    Box quantization_box;
    bool has_levels = false;
    struct Array {
        std::string name;
        ElementType type = ElementType::float32;
        std::uint64_t components = 1;
        bool operator==(const Array&) const = default;
    };
    std::vector<Array> arrays;

    explicit FrameForm(const ParticleFrame& frame);
    FrameForm() = default;
    /// Lives as long as this.
    std::vector<ParticleArray> without_values() const;
    bool operator==(const FrameForm&) const = default;
};

/// Owns the arrays of a frame: of a part's, or of a copy. Keeps its memory from frame to frame.
class PartParticles {
public:
    /// Forgets the particles. form: of the frames that come.
    void begin(FrameForm form);
    /// A message of ParticlesNear, of a frame of this form.
    void add(std::span<const std::byte> message);
    /// The frame, of what stays and of copies of the rest: lives as long as both.
    ParticleFrame keep(const HandedFrame& handed);
    /// Lives as long as this.
    const ParticleFrame& frame();

private:
    FrameForm form_;
    std::vector<float> positions_;
    std::vector<std::uint16_t> quantized_;
    std::vector<std::uint8_t> levels_;
    std::vector<std::vector<std::byte>> arrays_;
    std::vector<ParticleArray> borrowed_;
    ParticleFrame frame_;
};

}  // namespace meniscus
