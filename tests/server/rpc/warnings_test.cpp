// Warnings of a frame, as its simulator and its watchers receive them.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "running_server.hpp"
#include "sample_files.hpp"

namespace meniscus::server::test {
namespace {

/// Twelve particles a side, two radii apart: a radius three times too small.
Particles lattice(const Settings& settings) {
    const auto spacing = static_cast<float>(6.0 * settings.particle_radius);
    Particles particles;
    for (int i = 0; i < 12 * 12 * 12; ++i)
        for (const int x : {i % 12, i / 12 % 12, i / 144})
            particles.positions.push_back(spacing * static_cast<float>(x));
    return particles;
}

TEST(WarningsOverTheWire, AreThoseOfThisProcessForTheStreamTheWatcherAndTheSession) {
    Settings chosen = settings();
    chosen.field = Field::color;
    chosen.smoothing_length = 1.0;
    chosen.cell_size = 2.0;
    const Particles particles = lattice(chosen);
    Reconstructor here(chosen, {.threads = 1});
    Mesh mesh;
    here.reconstruct(particles.view(), mesh);
    const std::vector<Warning>& expected = here.statistics().warnings;
    ASSERT_EQ(expected.size(), 3U);
    EXPECT_EQ(expected[0].code, WarningCode::radius_too_small);

    RunningServer running;
    const std::string id = client::new_session_id();
    running.client.create_session(id, chosen);
    auto stream = running.client.stream(id);
    stream.push(particles.view(), 0, 0.0);
    stream.finish();
    const auto frame = stream.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->statistics.warnings, expected);
    EXPECT_FALSE(stream.next());
    auto watcher = running.client.watch(id, {.max_level = 1});
    const auto watched = watcher.next();
    ASSERT_TRUE(watched);
    EXPECT_EQ(watched->statistics.warnings, expected);
    const auto last = running.client.session(id).last_frame;
    ASSERT_TRUE(last);
    EXPECT_EQ(last->warnings, expected);
}

}  // namespace
}  // namespace meniscus::server::test
