// A simulator: pushes frames through a session of its own, and takes their meshes as they come.
//
//   simulator HOST:PORT [FRAMES]
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <meniscus/client/client.hpp>
#include <meniscus/mesh_hash.hpp>
#include <span>
#include <utility>
#include <vector>

#include "wave.h"

namespace {

using namespace std::chrono_literals;

void show(const meniscus::client::ReceivedFrame& frame) {
    const meniscus::Mesh mesh = frame.mesh();  // decodes what was received
    std::printf("frame %llu: %zu triangles, mesh %s\n", static_cast<unsigned long long>(frame.index),
                mesh.triangles.size(), mesh_sha256(mesh).c_str());
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc < 2) {
        std::fprintf(stderr, "usage: simulator HOST:PORT [FRAMES]\n");
        return 2;
    }
    const unsigned long frames = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 100;

    meniscus::Settings settings;
    settings.particle_radius = WAVE_PARTICLE_RADIUS;
    settings.cell_size = 1.0;
    settings.attributes = {"velocity"};  // the viewer colors the surface by it
    meniscus::client::Client client(argv[1]);
    // Ends when this object goes, or soon after this process has died.
    meniscus::client::Session session = client.open_session(
        settings, {.description = {.name = "standing wave", .up_axis = meniscus::client::UpAxis::z}});
    std::printf("session %s\n", session.id().c_str());
    std::fflush(stdout);

    // Should the server be out of reach for a while, frames are kept here and sent again.
    meniscus::client::Stream stream = session.stream({.reconnect = 30s});
    for (unsigned long index = 0; index < frames; ++index) {
        const double seconds = 0.1 * static_cast<double>(index);
        std::vector<float> positions(3 * WAVE_PARTICLES);
        std::vector<float> velocities(3 * WAVE_PARTICLES);
        wave_at(seconds, positions.data());
        wave_velocity_at(seconds, velocities.data());
        const std::array arrays{meniscus::ParticleArray{"velocity", std::as_bytes(std::span(velocities)),
                                                        meniscus::ElementType::float32, 3}};
        meniscus::ParticleFrame frame;
        frame.positions = positions;  // borrowed for the call, as the arrays are
        frame.arrays = arrays;
        stream.push(frame, index, seconds);
        // What has come already: the solver does not wait for meshes.
        while (const auto received = stream.next(0s)) show(*received);
    }
    stream.finish();
    while (const auto received = stream.next()) show(*received);
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
