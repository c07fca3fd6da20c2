// What publishers say of their surfaces reaches receivers, and nothing else of the server.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "dealt_bricks.hpp"
#include "observation/metrics.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

TEST(PublishersFigures, LeaveTheServersCountersAsTheyAre) {
    ServerOptions options = test_options();
    options.http = "127.0.0.1:0";
    RunningServer running(options);
    LocalSurface local(settings());
    local.reconstruct(wave(6, 0.1).view());
    auto publisher = running.client.publish(running.session());
    std::uint64_t triangles = 0;
    for (std::uint64_t i = 0; i < 3; ++i) {
        client::ReceivedFrame frame = local.encoded(i);
        triangles += frame.statistics.triangles;
        frame.statistics.volume = std::numeric_limits<double>::max();
        frame.statistics.particle_volume = std::numeric_limits<double>::max();
        frame.statistics.particles = std::numeric_limits<std::uint64_t>::max();
        frame.statistics.total_seconds = 1e300;
        publisher.push(frame);
        const auto answer = publisher.next();
        ASSERT_TRUE(answer);
        EXPECT_EQ(answer->statistics.volume, std::numeric_limits<double>::max());
    }
    const Samples samples = scrape_until(running.server.http_address(), "meniscus_surfaces_published_total", 3);
    EXPECT_EQ(samples.at("meniscus_frames_total"), 3);
    EXPECT_EQ(samples.at("meniscus_triangles_total"), static_cast<double>(triangles));
    EXPECT_EQ(samples.at("meniscus_frame_latency_seconds_count"), 3);
    for (const char* const of_reconstructions :
         {"meniscus_particles_total", "meniscus_mesh_volume_total", "meniscus_particle_volume_total",
          "meniscus_frame_reconstruction_seconds_sum"})
        EXPECT_EQ(samples.at(of_reconstructions), 0) << of_reconstructions;
}

TEST(PublishersFigures, HaveTheSecondsThatTheirMeshesTookFromTheGpu) {
    RunningServer running;
    LocalSurface local(settings());
    local.reconstruct(wave(6, 0.1).view());
    auto publisher = running.client.publish(running.session());
    client::ReceivedFrame frame = local.encoded(0);
    frame.statistics.download_seconds = 0.25;
    publisher.push(frame);
    const auto answer = publisher.next();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->statistics.download_seconds, 0.25);
}

}  // namespace
}  // namespace meniscus::server::test
