// The bricks of a surface, dealt out to several publishers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

#include "meniscus/brick_coding.hpp"
#include "meniscus/client/received_frame.hpp"
#include "meniscus/mesh.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::server::test {

/// A reconstruction in this process, with the lattice that publishers need.
struct LocalSurface {
    explicit LocalSurface(const Settings& settings) : reconstructor(settings, {.threads = 1, .keep_lattice = true}) {}

    void reconstruct(const ParticleFrame& frame) { reconstructor.reconstruct(frame, mesh); }
    /// bits: of float32 attributes.
    client::ReceivedFrame encoded(std::uint64_t index, Codec codec = Codec::lattice_packed, int bits = 0) const {
        CodingOptions coding{.normal_bits = mesh.normals.empty() ? 0 : 8, .codec = codec};
        const std::vector<AttributeWish> all{{.name = {}, .bits = bits}};
        coding.attributes = coded_attributes(mesh, attribute_ranges(mesh), all);
        return client::encode_frame(mesh, reconstructor.statistics(), index, 0.1 * static_cast<double>(index), coding);
    }

    Reconstructor reconstructor;
    Mesh mesh;
};

/// Each brick in one part, at random. Counts are those of a part's own bricks, a vertex of several parts in the first
/// of them; what the bricks do not tell is all in part 0.
inline std::vector<client::ReceivedFrame> dealt(const client::ReceivedFrame& whole, std::size_t parts, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<client::ReceivedFrame> frames(parts, whole);
    for (client::ReceivedFrame& frame : frames) frame.bricks.clear();
    for (const auto& brick : whole.bricks) frames[random() % parts].bricks.push_back(brick);
    std::set<LatticePosition> counted;
    for (std::size_t p = 0; p < parts; ++p) {
        client::FrameStatistics& statistics = frames[p].statistics;
        if (p != 0) {
            static_cast<Statistics&>(statistics) = {};
            frames[p].spray.clear();
        }
        statistics.vertices = 0;
        statistics.triangles = 0;
        statistics.triangles_by_level = {};
        statistics.total_seconds = static_cast<double>(p + 1);
        statistics.threads = 1;
        for (const auto& brick : frames[p].bricks) {
            const DecodedBrick decoded = decode_brick(*brick, whole.offset_bits, whole.coded_attributes);
            for (const LatticePosition& vertex : decoded.vertices) statistics.vertices += counted.insert(vertex).second;
            statistics.triangles += decoded.triangles.size();
            for (const TriangleLevel level : decoded.levels)
                ++statistics.triangles_by_level.at(static_cast<std::size_t>(level));
        }
    }
    return frames;
}

}  // namespace meniscus::server::test
