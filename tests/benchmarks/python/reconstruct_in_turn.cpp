// Reconstructs a frame once for each line on standard input, and answers with the seconds that the call took: the C++
// side of against-cpp.
#include <chrono>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>

#include "formats/particles/particle_file.hpp"
#include "meniscus/mesh_hash.hpp"
#include "meniscus/reconstructor.hpp"

int main(int argc, char** argv) try {
    if (argc != 3) {
        std::fprintf(stderr, "Usage: reconstruct-in-turn PARTICLES PARTICLE_RADIUS\n");
        return 2;
    }
    const meniscus::formats::Particles particles = meniscus::formats::read_particles(argv[1]);
    meniscus::Settings settings;
    settings.particle_radius = std::stod(argv[2]);
    meniscus::Reconstructor reconstructor(settings);
    meniscus::Mesh mesh;
    for (std::string line; std::getline(std::cin, line);) {
        const auto start = std::chrono::steady_clock::now();
        reconstructor.reconstruct(particles.frame(), mesh);
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        std::printf("%.9f\n", taken.count());
        std::fflush(stdout);
    }
    std::printf("%s\n", meniscus::mesh_sha256(mesh).c_str());
} catch (const std::exception& error) {
    std::fprintf(stderr, "reconstruct-in-turn: %s\n", error.what());
    return 1;
}
