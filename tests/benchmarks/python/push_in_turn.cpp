// Pushes frames for each line on standard input, and answers with the seconds that one took: the C++ side of
// push-against-cpp.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include "meniscus/client/client.hpp"

int main(int argc, char** argv) try {
    if (argc != 5) {
        std::fprintf(stderr, "Usage: push-in-turn ADDRESS PARTICLES PARTICLE_RADIUS FRAMES\n");
        return 2;
    }
    const std::vector<float> positions(3 * static_cast<std::size_t>(std::stoull(argv[2])), 0.5F);
    const int frames = std::stoi(argv[4]);
    meniscus::Settings settings;
    settings.particle_radius = std::stod(argv[3]);
    meniscus::client::Client client(argv[1]);
    auto session = client.open_session(settings);
    auto stream = session.stream(
        {.receive_meshes = false, .policy = meniscus::client::UploadPolicy::every_nth, .nth = 1'000'000'000});
    // The one that is reconstructed.
    stream.push(meniscus::StridedPositions(std::span(positions).first(3)), 0, 0.0);
    std::uint64_t index = 1;
    for (std::string line; std::getline(std::cin, line);) {
        const auto start = std::chrono::steady_clock::now();
        for (int i = 0; i < frames; ++i) stream.push(meniscus::StridedPositions(std::span(positions)), index++, 0.0);
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        std::printf("%.9f\n", taken.count() / frames);
        std::fflush(stdout);
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "push-in-turn: %s\n", error.what());
    return 1;
}
