// Ranges of attributes: those that the vertices have, and those that values are coded over.
#include "meniscus/attribute_coding.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <tuple>
#include <utility>

#include "codec/attribute_values.hpp"
#include "meniscus/error.hpp"

namespace meniscus {
namespace {

/// Numbers that are compared at a time: a multiple of every count of components, so that a lane sees one alone.
constexpr std::size_t lanes = 12;

template <class Number>
AttributeRange range_of(const MeshAttribute& attribute) {
    const std::size_t count = attribute.data.size() / sizeof(Number);
    const std::byte* at = attribute.data.data();
    std::array<Number, lanes> low;
    std::array<Number, lanes> high;
    low.fill(std::numeric_limits<Number>::max());
    high.fill(std::numeric_limits<Number>::lowest());
    std::array<Number, lanes> numbers;
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        std::memcpy(numbers.data(), at + i * sizeof(Number), sizeof numbers);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            low[lane] = numbers[lane] < low[lane] ? numbers[lane] : low[lane];
            high[lane] = numbers[lane] > high[lane] ? numbers[lane] : high[lane];
        }
    }
    std::memcpy(numbers.data(), at + i * sizeof(Number), (count - i) * sizeof(Number));
    for (std::size_t lane = 0; i < count; ++i, ++lane) {
        low[lane] = std::min(low[lane], numbers[lane]);
        high[lane] = std::max(high[lane], numbers[lane]);
    }
    AttributeRange range;
    for (std::size_t c = 0; c < attribute.components; ++c) {
        for (std::size_t lane = c; lane < lanes; lane += attribute.components) {
            low[c] = std::min(low[c], low[lane]);
            high[c] = std::max(high[c], high[lane]);
        }
        // Of two zeros the positive one, whichever was met first.
        range.minimum[c] = static_cast<double>(low[c]) + 0.0;
        range.maximum[c] = static_cast<double>(high[c]) + 0.0;
    }
    return range;
}

/// Rounds a range outward to multiples of a power of two, an eighth to a sixteenth of the extent. Every such multiple
/// is a float, but beyond the largest one.
std::pair<float, float> coded_range(double minimum, double maximum) {
    constexpr double largest = std::numeric_limits<float>::max();
    const double extent = maximum - minimum;
    if (!(extent > 0.0)) return {static_cast<float>(minimum), static_cast<float>(minimum)};
    const double unit = std::ldexp(1.0, std::ilogb(extent) - 3);
    return {static_cast<float>(std::max(std::floor(minimum / unit) * unit, -largest)),
            static_cast<float>(std::min(std::ceil(maximum / unit) * unit, largest))};
}

CodedAttribute coded_attribute(const MeshAttribute& attribute, int bits) {
    CodedAttribute coded;
    coded.name = attribute.name;
    coded.type = attribute.type;
    coded.components = attribute.components;
    coded.bits = attribute.type == ElementType::float32 ? bits : 0;
    return coded;
}

void require_bits(const AttributeWish& wish) {
    if (wish.bits < 0 || wish.bits > max_attribute_bits)
        throw InvalidInput("attribute '" + wish.name + "' is wished for with " + std::to_string(wish.bits) +
                           " bits, must be 1 to " + std::to_string(max_attribute_bits) + ", or 0 for exact values");
}

void round_values(MeshAttribute& attribute, const CodedAttribute& coded) {
    const std::size_t numbers = attribute.data.size() / sizeof(float);
    for (std::size_t c = 0; c < coded.components; ++c) {
        const CodedRange range(coded, c);
        for (std::size_t i = c; i < numbers; i += coded.components) {
            std::byte* at = attribute.data.data() + i * sizeof(float);
            float value;
            std::memcpy(&value, at, sizeof value);
            value = range.value(range.number(value));
            std::memcpy(at, &value, sizeof value);
        }
    }
}

}  // namespace

std::size_t CodedAttribute::coded_bytes() const {
    if (bits == 0) return size_of(type) * components;
    return bits <= 8 ? components : 2 * components;
}

std::vector<AttributeRange> attribute_ranges(const Mesh& mesh) {
    std::vector<AttributeRange> ranges;
    if (mesh.vertices.empty()) return ranges;
    ranges.reserve(mesh.attributes.size());
    for (const MeshAttribute& attribute : mesh.attributes) switch (attribute.type) {
            case ElementType::float32:
                ranges.push_back(range_of<float>(attribute));
                break;
            case ElementType::uint8:
                ranges.push_back(range_of<std::uint8_t>(attribute));
                break;
            case ElementType::int32:
                ranges.push_back(range_of<std::int32_t>(attribute));
                break;
            case ElementType::uint32:
                ranges.push_back(range_of<std::uint32_t>(attribute));
                break;
        }
    return ranges;
}

std::vector<CodedAttribute> coded_attributes(const Mesh& mesh, std::span<const AttributeRange> ranges,
                                             std::span<const AttributeWish> wishes) {
    std::vector<CodedAttribute> result;
    for (const AttributeWish& wish : wishes) require_bits(wish);
    for (std::size_t a = 0; a < mesh.attributes.size(); ++a) {
        auto wish = std::ranges::find(wishes, mesh.attributes[a].name, &AttributeWish::name);
        if (wish == wishes.end()) wish = std::ranges::find(wishes, std::string_view(), &AttributeWish::name);
        if (wish == wishes.end()) continue;
        CodedAttribute coded = coded_attribute(mesh.attributes[a], wish->bits);
        for (std::size_t c = 0; coded.bits != 0 && !ranges.empty() && c < coded.components; ++c)
            std::tie(coded.minimum[c], coded.maximum[c]) = coded_range(ranges[a].minimum[c], ranges[a].maximum[c]);
        result.push_back(std::move(coded));
    }
    return result;
}

void round_attributes(Mesh& mesh, std::span<const AttributeWish> wishes) {
    const std::vector<CodedAttribute> coded = coded_attributes(mesh, attribute_ranges(mesh), wishes);
    std::erase_if(mesh.attributes, [&](const MeshAttribute& attribute) {
        return std::ranges::find(coded, attribute.name, &CodedAttribute::name) == coded.end();
    });
    for (std::size_t a = 0; a < coded.size(); ++a)
        if (coded[a].bits != 0) round_values(mesh.attributes[a], coded[a]);
}

}  // namespace meniscus
