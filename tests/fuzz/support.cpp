#include "support.hpp"

#include "meniscus/reconstructor.hpp"

namespace meniscus::fuzz {

Mesh sample_mesh() {
    // Two drops of different size, one on the border between two bricks.
    constexpr float spacing = 0.2F;
    std::vector<float> positions{3.0F, 3.0F, 3.0F};
    for (int i = 0; i < 27; ++i)
        for (const int step : {i % 3, i / 3 % 3, i / 9})
            positions.push_back(spacing * static_cast<float>(step) - spacing);
    ParticleFrame frame;
    frame.positions = positions;
    Settings settings;
    settings.particle_radius = 0.1;
    settings.cell_size = 1.0;
    Mesh mesh;
    Reconstructor(settings, {.threads = 1}).reconstruct(frame, mesh);
    return mesh;
}

}  // namespace meniscus::fuzz
