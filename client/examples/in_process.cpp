// Surfaces in the simulator's own process, from C++.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <meniscus/meniscus.hpp>
#include <vector>

#include "wave.h"

int main() try {
    meniscus::Settings settings;
    settings.particle_radius = WAVE_PARTICLE_RADIUS;
    settings.cell_size = 1.0;

    // One reconstructor and one mesh for all frames: they keep their memory.
    meniscus::Reconstructor reconstructor(settings);
    meniscus::Mesh mesh;
    std::vector<float> positions(3 * WAVE_PARTICLES);
    for (int i = 0; i < 5; ++i) {
        wave_at(0.1 * i, positions.data());
        meniscus::ParticleFrame frame;
        frame.positions = positions;  // borrowed for the call
        reconstructor.reconstruct(frame, mesh);

        // Vertices are exact lattice coordinates; world() gives them in world units.
        double highest = mesh.world(mesh.vertices.at(0))[2];
        for (const meniscus::LatticePosition& vertex : mesh.vertices)
            highest = std::max(highest, mesh.world(vertex)[2]);
        std::printf("frame %d: %zu triangles up to height %.3f, mesh %s\n", i, mesh.triangles.size(), highest,
                    mesh_sha256(mesh).c_str());
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
