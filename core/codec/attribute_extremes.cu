#include "codec/attribute_extremes.hpp"

#include "engine/cuda/warp.hpp"
#include "particles/attribute_choice.hpp"

namespace meniscus::cuda {
namespace {

constexpr std::uint32_t sign = std::uint32_t{1} << 31;

/// A number in an order of unsigned numbers.
__device__ std::uint32_t ordered_number(const std::byte* values, ElementType type, std::uint64_t at) {
    if (type == ElementType::uint8) return static_cast<std::uint8_t>(values[at]);
    const std::uint32_t bits = reinterpret_cast<const std::uint32_t*>(values)[at];
    if (type == ElementType::float32) return ordered_bits(bits);
    return type == ElementType::int32 ? bits ^ sign : bits;
}

double number(std::uint32_t ordered, ElementType type) {
    switch (type) {
        case ElementType::float32:
            // Of two zeros the positive one.
            return static_cast<double>(from_ordered_bits(ordered)) + 0.0;
        case ElementType::int32:
            return static_cast<std::int32_t>(ordered ^ sign);
        case ElementType::uint8:
        case ElementType::uint32:
            break;
    }
    return ordered;
}

__device__ void keep_greatest(std::uint32_t* kept, std::uint32_t value) {
    for (unsigned distance = warp_threads / 2; distance > 0; distance /= 2) {
        const std::uint32_t other = __shfl_xor_sync(all_lanes, value, static_cast<int>(distance));
        value = other > value ? other : value;
    }
    if (lane_index() == 0) atomicMax(kept, value);
}

__global__ void __launch_bounds__(block_threads)
    keep_extremes(const std::byte* values, ElementType type, std::uint32_t vertices, std::uint32_t components,
                  AttributeExtremes* extremes) {
    for (std::uint32_t c = 0; c < components; ++c) {
        std::uint32_t greatest = 0;
        std::uint32_t least = 0;
        GridLoop{}.each(vertices, [&](std::uint32_t v) {
            const std::uint32_t ordered = ordered_number(values, type, std::uint64_t{components} * v + c);
            if (ordered > greatest) greatest = ordered;
            if (~ordered > least) least = ~ordered;
        });
        keep_greatest(&extremes->greatest[c], greatest);
        keep_greatest(&extremes->least[c], least);
    }
}

}  // namespace

AttributeRange AttributeExtremes::range(ElementType type, std::size_t components) const {
    AttributeRange range;
    for (std::size_t c = 0; c < components; ++c) {
        range.minimum[c] = number(~least[c], type);
        range.maximum[c] = number(greatest[c], type);
    }
    return range;
}

void find_extremes(const std::byte* values, ElementType type, std::uint32_t vertices, std::size_t components,
                   AttributeExtremes* extremes, const Launcher& launch) {
    launch(vertices, block_threads, keep_extremes, values, type, vertices, static_cast<std::uint32_t>(components),
           extremes);
}

}  // namespace meniscus::cuda
