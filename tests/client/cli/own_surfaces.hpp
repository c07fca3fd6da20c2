// Surfaces that are made in the test's process, as publishers have them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "meniscus/attribute_coding.hpp"
#include "meniscus/client/client.hpp"
#include "meniscus/reconstructor.hpp"
#include "pushing/brick_bytes.hpp"

namespace meniscus::test {

inline client::ReceivedFrame surface_of(const Settings& settings, const ParticleFrame& particles, std::uint64_t index,
                                        Codec codec = Codec::lattice_packed) {
    Reconstructor reconstructor(settings, {.backend = Backend::cpu, .threads = 1, .keep_lattice = true});
    Mesh mesh;
    reconstructor.reconstruct(particles, mesh);
    CodingOptions coding{.normal_bits = settings.normals ? 8 : 0, .codec = codec};
    const std::vector<AttributeWish> exactly{{.name = {}, .bits = 0}};
    coding.attributes = coded_attributes(mesh, attribute_ranges(mesh), exactly);
    return client::encode_frame(mesh, reconstructor.statistics(), index, 0.5 * static_cast<double>(index), coding);
}

/// As a program writes it that has no Protocol Buffers.
inline std::string bytes_of(const client::ReceivedFrame& frame) {
    std::string out;
    for (const pushing::FramePiece& piece : pushing::brick_pieces(frame))
        out.append(piece.head).append(reinterpret_cast<const char*>(piece.data.data()), piece.data.size());
    return out;
}

}  // namespace meniscus::test
