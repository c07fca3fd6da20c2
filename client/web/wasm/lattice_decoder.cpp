// The lattice codec's decoder for the viewer, as a WebAssembly module without imports. It gives a brick in the arrays
// that the graphics hardware reads; src/decode/lattice_module.ts calls it.
#include "codec/lattice/lattice_decoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/lattice/octahedron.hpp"

namespace meniscus {
namespace {

constexpr std::size_t max_attributes = 16;
constexpr std::uint32_t most_short_vertices = 0xFFFF;  ///< so that uint16 number them

struct Limits {
    std::array<std::uint32_t, 3> min;
    std::array<std::uint32_t, 3> max;
};

/// All of it is used again for one brick after another.
struct Memory {
    std::vector<std::byte> input;
    std::array<std::size_t, max_attributes> attribute_bytes{};
    LatticeDecoder decoder;
    std::vector<std::array<std::uint16_t, 4>> positions;
    std::vector<std::array<std::int16_t, 4>> normals;
    std::vector<std::array<std::uint16_t, 3>> short_triangles;
    std::vector<Triangle> triangles;
    std::array<std::uint32_t, triangle_level_count> level_triangles{};
    Limits limits{};
};

Memory& memory() {
    static Memory only;
    return only;
}

/// To four shorts a vertex.
void give_positions(const LatticeBrick& brick, Memory& to) {
    to.positions.resize(brick.positions.size());
    auto& [min, max] = to.limits;
    min.fill(0xFFFF);
    max.fill(0);
    for (std::size_t v = 0; v < brick.positions.size(); ++v)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto value = static_cast<std::uint32_t>(brick.positions[v][axis]);
            min[axis] = std::min(min[axis], value);
            max[axis] = std::max(max[axis], value);
            to.positions[v][axis] = static_cast<std::uint16_t>(value);
        }
}

/// Unit vectors times 32767. Returns whether all are normals.
bool give_normals(const LatticeBrick& brick, Memory& to) {
    to.normals.resize(brick.normals.size());
    if (brick.normals.empty()) return true;
    const Octahedron octahedron(brick.normal_bits);
    for (std::size_t v = 0; v < brick.normals.size(); ++v) {
        if (!octahedron.holds(brick.normals[v])) return false;
        const std::array<float, 3> normal = octahedron.vector(brick.normals[v]);
        for (std::size_t axis = 0; axis < 3; ++axis)
            to.normals[v][axis] = static_cast<std::int16_t>(std::lround(normal[axis] * 32767.0F));
    }
    return true;
}

/// Each level's triangles together, so that a level is one range to draw.
template <class Index>
void order_by_level(const LatticeBrick& brick, const std::array<std::uint32_t, triangle_level_count>& counts,
                    std::vector<std::array<Index, 3>>& out) {
    out.resize(brick.triangles.size());
    std::array<std::array<Index, 3>*, triangle_level_count> next{out.data()};
    for (std::size_t level = 1; level < next.size(); ++level) next[level] = next[level - 1] + counts[level - 1];
    for (std::size_t t = 0; t < brick.triangles.size(); ++t) {
        const auto& [a, b, c] = brick.triangles[t];
        *next[static_cast<std::size_t>(brick.levels[t])]++ = {static_cast<Index>(a), static_cast<Index>(b),
                                                              static_cast<Index>(c)};
    }
}

void give_triangles(const LatticeBrick& brick, Memory& to) {
    to.level_triangles.fill(0);
    for (const TriangleLevel level : brick.levels) ++to.level_triangles[static_cast<std::size_t>(level)];
    if (brick.positions.size() <= most_short_vertices)
        order_by_level(brick, to.level_triangles, to.short_triangles);
    else
        order_by_level(brick, to.level_triangles, to.triangles);
}

}  // namespace
}  // namespace meniscus

// The functions of the module. A pointer holds until the next brick.
using meniscus::memory;

#define EXPORTED(name) __attribute__((export_name(#name))) extern "C"

/// The place for a brick's bytes.
EXPORTED(input) std::byte* input(std::size_t bytes) {
    memory().input.resize(bytes);
    return memory().input.data();
}

/// The place for the bytes of each attribute of a vertex, at most 16 numbers.
EXPORTED(attribute_bytes) std::size_t* attribute_bytes() {
    return memory().attribute_bytes.data();
}

/// Decodes the input. Returns what is wrong with it, in words that end with a 0, or null.
EXPORTED(decode)
const char* decode(std::uint32_t vertices, std::uint32_t triangles, int offset_bits, std::size_t attributes) {
    meniscus::Memory& all = memory();
    const char* const fault = all.decoder.decode(all.input,
                                                 {.vertices = vertices,
                                                  .triangles = triangles,
                                                  .offset_bits = offset_bits,
                                                  .attribute_bytes = std::span(all.attribute_bytes).first(attributes)},
                                                 {});
    if (fault != nullptr) return fault;
    const meniscus::LatticeBrick& brick = all.decoder.brick();
    give_positions(brick, all);
    if (!give_normals(brick, all)) return "has a normal that is none";
    give_triangles(brick, all);
    return nullptr;
}

/// uint16, x y z and a padding for each vertex.
EXPORTED(positions) const void* positions() {
    return memory().positions.data();
}

/// int16, x y z and a padding for each vertex; null without normals.
EXPORTED(normals) const void* normals() {
    return memory().normals.empty() ? nullptr : memory().normals.data();
}

/// Three vertices for each triangle, uint16 for at most 65535 vertices, otherwise uint32.
EXPORTED(indices) const void* indices() {
    if (memory().positions.size() <= meniscus::most_short_vertices) return memory().short_triangles.data();
    return memory().triangles.data();
}

/// Four counts.
EXPORTED(level_triangles) const std::uint32_t* level_triangles() {
    return memory().level_triangles.data();
}

/// The least position on each axis, then the largest.
EXPORTED(bounds) const std::uint32_t* bounds() {
    return memory().limits.min.data();
}

/// The bytes of an attribute of all vertices.
EXPORTED(attribute) const std::byte* attribute(std::size_t place) {
    return memory().decoder.brick().attributes[place].data();
}

// What the standard library's checks would throw ends the module in a trap, after which the viewer starts a new one.
extern "C" void* __cxa_allocate_exception(std::size_t /*bytes*/) {
    __builtin_trap();
}
extern "C" void __cxa_throw(void* /*thrown*/, void* /*type*/, void (* /*destroy*/)(void*)) {
    __builtin_trap();
}
