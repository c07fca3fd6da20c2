// Frames to publish, and publications in memory.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "formats/recordings/brick_file.hpp"
#include "meniscus/client/publication.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh_hash.hpp"
#include "meniscus/reconstructor.hpp"

namespace meniscus::test {

inline Settings published_settings() {
    Settings settings;
    settings.particle_radius = 0.125;
    settings.attributes = {"age"};
    return settings;
}

/// A row of particles, of which the last moves: bricks at the row's other end stay as they are.
class Row {
public:
    Row() : reconstructor_(published_settings(), {.threads = 1, .keep_lattice = true}) {}

    client::ReceivedFrame frame(std::uint64_t index, std::uint64_t run_id = 0, Codec codec = Codec::lattice_entropy) {
        constexpr std::size_t count = 80;
        std::vector<float> positions;
        for (std::size_t i = 0; i < count; ++i) positions.insert(positions.end(), {0.2F * static_cast<float>(i), 0, 0});
        positions[3 * count - 2] = 0.01F * static_cast<float>(index);
        const std::vector<float> ages(count, 1.0F);
        const std::vector arrays{ParticleArray{"age", std::as_bytes(std::span(ages))}};
        ParticleFrame particles;
        particles.positions = positions;
        particles.arrays = arrays;
        reconstructor_.reconstruct(particles, mesh_);
        const std::vector<AttributeWish> wishes{{.name = {}, .bits = 8}};
        client::ReceivedFrame frame = client::encode_frame(
            mesh_, reconstructor_.statistics(), index, 0.1 * static_cast<double>(index),
            {.codec = codec, .attributes = coded_attributes(mesh_, attribute_ranges(mesh_), wishes)});
        frame.run_id = run_id;
        return frame;
    }
    /// That the mesh of the newest frame has.
    std::string sha256() const { return mesh_sha256(mesh_); }

private:
    Reconstructor reconstructor_;
    Mesh mesh_;
};

/// Files by name.
using Files = std::map<std::string, std::string>;

inline client::Publication publication_of(const Files& files) {
    return {"p", [files](const std::string& name, std::uint64_t most) {
                const auto found = files.find(name);
                if (found == files.end()) throw InvalidInput("p: no such file: " + name);
                if (found->second.size() > most) throw InvalidInput("p: " + name + " is too large");
                return found->second;
            }};
}

}  // namespace meniscus::test
