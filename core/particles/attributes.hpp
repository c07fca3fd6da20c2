// The numbers that vertices get from the particles' arrays: means of amounts, and ids of single particles.
//
// Numbers are summed in groups of four, so that a particle's numbers of a group are one load. Amounts come first, then,
// in groups of their own, ids. (core/README.md#attributes)
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "field/lanes.hpp"
#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"
#include "meniscus/element_type.hpp"
#include "meniscus/particle_frame.hpp"

namespace meniscus {

inline constexpr unsigned group_size_of_numbers = 4;

/// One number of an attribute.
struct AttributeNumber {
    std::uint8_t array = 0;  ///< index of its array in the frame and of its attribute in the mesh
    std::uint8_t component = 0;
    std::uint8_t components = 1;  ///< components of the array
    ElementType type = ElementType::float32;
    // The extremes of an amount over all particles. A mean lies between them, so that a constant arrives exactly.
    float least = 0.0F, greatest = 0.0F;
    /// A power of two by which particles' values are multiplied before they are summed, so that sums stay finite.
    float scale = 1.0F;

    /// The number of a particle as it is summed: an amount, scaled; or the bits of an id, in an order of unsigned
    /// numbers. data: the array.
    MENISCUS_HD float of_particle(const std::byte* data, std::uint32_t particle) const {
        const std::size_t at = std::size_t{particle} * components + component;
        if (type == ElementType::uint8) return static_cast<float>(static_cast<std::uint8_t>(data[at]));
        float value = 0.0F;
        __builtin_memcpy(&value, data + 4 * at, sizeof value);  // which may lie anywhere
        if (type == ElementType::float32) return value * scale;
        return as_float(as_bits(value) ^ sign());
    }

    /// The mean. sum: of the particles' numbers, each times its share; weight: sum of the shares. F is float or Lanes.
    template <class F>
    MENISCUS_HD F mean(F sum, F weight) const {
        return max(min(sum / weight * F(1.0F / scale), F(greatest)), F(least));
    }
    /// The mean at a place where this particle's number alone counts.
    MENISCUS_HD float alone(float number) const { return is_id(type) ? number : mean(number, 1.0F); }

    /// The number of a vertex without a particle near it: 0.
    MENISCUS_HD float nothing() const { return as_float(sign()); }

    /// Gives `count` vertices from the first on their means, or their ids. data: of the attribute.
    MENISCUS_HD void write(std::byte* data, std::uint32_t first, const float* values, std::uint32_t count) const {
        const std::size_t at = std::size_t{first} * components + component;
        if (type == ElementType::uint8) {
            for (std::uint32_t i = 0; i < count; ++i) {
                const float whole = trunc(values[i]);
                data[at + std::size_t{i} * components] =
                    static_cast<std::byte>(static_cast<int>(whole) + (values[i] - whole >= 0.5F ? 1 : 0));
            }
        } else if (type == ElementType::float32) {
            float* const out = reinterpret_cast<float*>(data) + at;
            for (std::uint32_t i = 0; i < count; ++i) out[std::size_t{i} * components] = values[i];
        } else {
            auto* const out = reinterpret_cast<std::uint32_t*>(data) + at;
            for (std::uint32_t i = 0; i < count; ++i) out[i] = as_bits(values[i]) ^ sign();
        }
    }

    MENISCUS_HD static std::uint32_t as_bits(float value) {
        std::uint32_t bits = 0;
        __builtin_memcpy(&bits, &value, sizeof bits);
        return bits;
    }
    MENISCUS_HD static float as_float(std::uint32_t bits) {
        float value = 0.0F;
        __builtin_memcpy(&value, &bits, sizeof value);
        return value;
    }

private:
    MENISCUS_HD std::uint32_t sign() const { return type == ElementType::int32 ? std::uint32_t{1} << 31 : 0; }
};

/// The number of numbers that vertices have, and their bytes.
struct AttributeShape {
    std::uint32_t amounts = 0, ids = 0;
    std::uint32_t arrays = 0;
    std::uint8_t vertex_bytes[max_particle_arrays] = {};  ///< bytes of a vertex's value, for each array

    bool operator==(const AttributeShape&) const = default;
    MENISCUS_HD unsigned amount_groups() const { return (amounts + group_size_of_numbers - 1) / group_size_of_numbers; }
    MENISCUS_HD unsigned groups() const {
        return amount_groups() + (ids + group_size_of_numbers - 1) / group_size_of_numbers;
    }
    MENISCUS_HD bool are_ids(unsigned group) const { return group >= amount_groups(); }
    /// The numbers in a group.
    MENISCUS_HD unsigned count(unsigned group) const {
        const unsigned left = are_ids(group) ? ids - group_size_of_numbers * (group - amount_groups())
                                             : amounts - group_size_of_numbers * group;
        return left < group_size_of_numbers ? left : group_size_of_numbers;
    }
};

/// The numbers of a frame's arrays, by group.
struct AttributeNumbers {
    AttributeShape shape;
    AttributeNumber of[max_particle_arrays * group_size_of_numbers];

    MENISCUS_HD const AttributeNumber* group(unsigned g) const { return of + group_size_of_numbers * g; }
};

/// The numbers of arrays that can be attributes, without the amounts' ranges.
inline AttributeNumbers attribute_numbers(std::span<const ParticleArray> arrays) {
    AttributeNumbers numbers;
    const auto add = [&](bool ids, std::uint32_t& count, unsigned first) {
        for (std::size_t a = 0; a < arrays.size(); ++a)
            for (std::size_t c = 0; is_id(arrays[a].type) == ids && c < arrays[a].components; ++c)
                numbers.of[first + count++] = {static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(c),
                                               static_cast<std::uint8_t>(arrays[a].components), arrays[a].type};
    };
    add(false, numbers.shape.amounts, 0);
    add(true, numbers.shape.ids, group_size_of_numbers * numbers.shape.amount_groups());
    for (const ParticleArray& array : arrays)
        numbers.shape.vertex_bytes[numbers.shape.arrays++] = static_cast<std::uint8_t>(array.element_bytes());
    return numbers;
}

/// Sets the amounts' ranges. least, greatest: extremes of a float32 array's component.
inline void set_range(AttributeNumber& number, float least, float greatest) {
    constexpr float large = 0x1p64F;
    number.least = least;
    number.greatest = greatest;
    if (least < -large || greatest > large) number.scale = 1.0F / large;
}
inline void set_range_of_bytes(AttributeNumber& number) {
    number.greatest = 255.0F;
}

/// The particle with the largest share at a point; of several the smallest of each id.
struct LargestShare {
    float share = 0.0F;
    std::uint32_t ids[group_size_of_numbers] = {};

    /// numbers: the particle's numbers in a group of ids.
    MENISCUS_HD void add(float other, const float* numbers) {
        if (other < share || other == 0.0F) return;
        for (unsigned i = 0; i < group_size_of_numbers; ++i) {
            const std::uint32_t id = AttributeNumber::as_bits(numbers[i]);
            if (other > share || id < ids[i]) ids[i] = id;
        }
        share = other;
    }
};

/// The particle nearest to a point, of those that reach the point's base cell; of several the first. All coordinates
/// are units from that cell's corner.
struct NearestParticle {
    static constexpr float nowhere = 0x1p126F;

    float x, y, z;                     ///< the point
    float squared_distance = nowhere;  ///< squared distance of the particle from the point
    unsigned level = 0;
    std::uint32_t rank = 0;

    template <class Kernel>
    MENISCUS_HD void consider(const Kernel& kernel, float px, float py, float pz, unsigned its_level,
                              std::uint32_t its_rank) {
        const auto gap = [](float v) { return max(max(-v, v - base_edge), 0.0F); };
        if (!(kernel.share(gap(px), gap(py), gap(pz)) > 0.0F)) return;
        const float dx = px - x, dy = py - y, dz = pz - z;
        const float d2 = fma(dx, dx, fma(dy, dy, dz * dz));
        if (d2 >= squared_distance) return;
        squared_distance = d2;
        level = its_level;
        rank = its_rank;
    }
    MENISCUS_HD bool exists() const { return squared_distance < nowhere; }
};

}  // namespace meniscus
