// Values of attributes as the bytes that stand for them in bricks, and back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lattice/host_device.hpp"
#include "meniscus/attribute_coding.hpp"

namespace meniscus {

/// One component of an attribute with bits: a value is a number of steps from the lower end of its range.
class CodedRange {
public:
    CodedRange() = default;
    CodedRange(const CodedAttribute& form, std::size_t component);

    /// The number of the nearest step; for a value beyond the range that of its end.
    MENISCUS_HD std::uint32_t number(float value) const {
        const double steps = (value - minimum_) * steps_per_unit_ + 0.5;
        // In this order NaN is the lower end.
        const double from_zero = steps > 0.0 ? steps : 0.0;
        return static_cast<std::uint32_t>(from_zero < steps_ ? from_zero : steps_);
    }
    /// number: at most 2^bits - 1.
    float value(std::uint32_t number) const;

private:
    double minimum_ = 0.0;
    double extent_ = 0.0;
    double steps_ = 0.0;
    double steps_per_unit_ = 0.0;
};

/// Throws InvalidInput unless an attribute can be coded so.
void require_codable(const CodedAttribute& form);

/// The mesh's attribute of this form. Throws InvalidInput if there is none.
const MeshAttribute& attribute_of(const Mesh& mesh, const CodedAttribute& form);

/// coded_bytes() for each of these vertices, little-endian. form: of this attribute.
std::vector<std::byte> coded_values(const MeshAttribute& attribute, const CodedAttribute& form,
                                    std::span<const std::uint32_t> vertices);

/// coded: coded_bytes() for each vertex. Throws InvalidInput for numbers of more than the form's bits, and for float32
/// that is not finite.
MeshAttribute decoded_values(const CodedAttribute& form, std::span<const std::byte> coded);

}  // namespace meniscus
