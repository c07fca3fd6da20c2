// How the attributes of vertices are coded in bricks: exactly, or float32 over a range that all bricks of a mesh share.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "meniscus/mesh.hpp"

namespace meniscus {

inline constexpr int max_attribute_bits = 16;
inline constexpr int default_attribute_bits = 8;
inline constexpr std::size_t max_attribute_components = 4;

/// A receiver's request for an attribute.
struct AttributeWish {
    std::string name;  ///< name of the attribute; empty: every one without a request of its own
    int bits =
        default_attribute_bits;  ///< bits per component of float32, 1 to max_attribute_bits; 0: exact, as are integers
    auto operator<=>(const AttributeWish&) const =
        default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 means what the compiler writes here
};

/// Smallest and largest value of each component over all vertices.
struct AttributeRange {
    std::array<double, max_attribute_components> minimum{};
    std::array<double, max_attribute_components> maximum{};
    bool operator==(const AttributeRange&) const = default;
};

/// An attribute as the bricks of a mesh carry it.
struct CodedAttribute {
    std::string name;
    ElementType type = ElementType::float32;
    std::size_t components = 1;
    int bits = 0;  ///< bits per component; 0: exact, as integers always are
    /// With bits: a value q of a component is minimum + q (maximum - minimum) / (2^bits - 1).
    std::array<float, max_attribute_components> minimum{};
    std::array<float, max_attribute_components> maximum{};

    bool operator==(const CodedAttribute&) const = default;
    /// Bytes of one vertex in a brick: 1 or 2 for each component with bits, else those of the type.
    std::size_t coded_bytes() const;
};

/// The range of each attribute of the mesh; none for a mesh without vertices.
std::vector<AttributeRange> attribute_ranges(const Mesh& mesh);

/// The forms of the mesh's attributes that are requested, in the mesh's order; other requests are passed over.
/// Ranges are rounded outward, so that they stay the same from frame to frame as long as they can.
std::vector<CodedAttribute> coded_attributes(const Mesh& mesh, std::span<const AttributeRange> ranges,
                                             std::span<const AttributeWish> wishes);

/// Gives the mesh the attributes that it would have if it were coded for these requests and decoded: the others go.
void round_attributes(Mesh& mesh, std::span<const AttributeWish> wishes);

}  // namespace meniscus
