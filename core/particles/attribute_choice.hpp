// Which of a frame's arrays become attributes of the vertices, and whether they can.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "meniscus/device_mesh.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/part.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"
#include "particles/attributes.hpp"

namespace meniscus {

/// Throws InvalidInput for names that cannot be.
void validate_attribute_names(const Settings& settings);

/// What the frames of one reconstructor have in common.
class AttributeChoice {
public:
    /// The settings must be valid.
    explicit AttributeChoice(const Settings& settings);

    /// The arrays of a frame of valid lengths that become attributes, in their order; none for a frame that has no
    /// particles and lacks one. Throws InvalidInput for one that is missing, comes twice, cannot be an attribute, or
    /// differs from that of the frames before. Changes nothing.
    std::vector<ParticleArray> of(const ParticleFrame& frame) const;
    /// After the frame has been accepted: holds the next ones against it.
    void keep(std::span<const ParticleArray> chosen);

    /// Gives a mesh the attributes that are known, without values.
    void shape(Mesh& mesh, const std::shared_ptr<MemoryAccount>& account) const;

    /// Writes the names and forms of the attributes of a mesh on a device.
    void describe(std::vector<DeviceMeshAttribute>& attributes) const;

private:
    struct Form {
        std::string name;
        ElementType type;
        std::size_t components;
    };

    std::vector<std::string> names_;  ///< with takes_all_, those of the first frame that brought some
    bool takes_all_;
    std::vector<Form> forms_;  ///< none until a frame was accepted
};

/// Throws InvalidInput, with its name and its particle, for a value that is not finite.
AttributeNumbers numbers_in_host_memory(std::span<const ParticleArray> chosen);
/// Gives the numbers of a part's particles the ranges of the whole frame, where there are some. chosen: the arrays that
/// they are of. Throws InvalidInput for a range that is not finite, or does not hold that of the particles.
void set_ranges(AttributeNumbers& numbers, std::span<const ParticleArray> chosen, std::span<const ArrayRange> ranges);
/// value: the index among all of the array's values of one that is not finite. Throws InvalidInput.
[[noreturn]] void refuse_value(const ParticleArray& array, std::uint64_t value);

/// Float32 numbers in an order of unsigned numbers, -0 before 0 and what is not finite at its ends: the least and the
/// greatest of some are the same in whatever order they are looked at.
MENISCUS_HD inline std::uint32_t ordered_bits(std::uint32_t bits) {
    return (bits >> 31) != 0 ? ~bits : bits | std::uint32_t{1} << 31;
}
inline float from_ordered_bits(std::uint32_t ordered) {
    return AttributeNumber::as_float((ordered >> 31) != 0 ? ordered & ~(std::uint32_t{1} << 31) : ~ordered);
}

}  // namespace meniscus
