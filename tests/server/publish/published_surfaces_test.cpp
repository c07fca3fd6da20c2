// A session of surfaces that were made elsewhere shows the same as one that reconstructs their particles.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "client_library/frames_with_arrays.hpp"
#include "dealt_bricks.hpp"
#include "meniscus/error.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

struct Form {
    Codec codec;
    int attribute_bits;
};
constexpr Form forms[] = {{Codec::lattice_packed, 0},
                          {Codec::lattice_entropy, 0},
                          {Codec::draco, 0},
                          {Codec::lattice_packed, 8},
                          {Codec::lattice_entropy, 12}};

client::WatchOptions options_of(const Form& form) {
    return {.codec = form.codec, .attributes = {{.name = {}, .bits = form.attribute_bits}}, .spray = true};
}

/// What watchers of every form see of each frame, and the statistics of each. upload: sends a frame, and waits until it
/// is answered.
struct Seen {
    std::vector<std::string> fingerprints;
    std::vector<client::FrameStatistics> statistics;
};
Seen watched(client::Client& client, const std::string& id, std::size_t frames,
             const std::function<void(std::size_t frame)>& upload) {
    std::vector<client::Watcher> watchers;
    for (const Form& form : forms) watchers.push_back(client.watch(id, options_of(form)));
    Seen seen;
    for (std::size_t f = 0; f < frames; ++f) {
        upload(f);
        for (client::Watcher& watcher : watchers) {
            const auto frame = watcher.next();
            EXPECT_TRUE(frame && frame->index == f);
            if (!frame) return seen;
            seen.fingerprints.push_back(fingerprint(*frame));
            if (&watcher == &watchers.front()) seen.statistics.push_back(frame->statistics);
        }
    }
    return seen;
}

Seen streamed(client::Client& client, const Settings& with, const std::vector<Dealt>& frames) {
    const std::string id = client::new_session_id();
    client.create_session(id, with);
    auto stream = client.stream(id, {.receive_meshes = false});
    Seen seen = watched(client, id, frames.size(), [&](std::size_t f) {
        std::vector<ParticleArray> arrays;
        stream.push(frames[f].view(arrays), f, 0.1 * static_cast<double>(f));
        EXPECT_TRUE(stream.next());
    });
    client.delete_session(id);
    return seen;
}

std::vector<client::ReceivedFrame> surfaces_of(const Settings& with, const std::vector<Dealt>& frames, Codec codec) {
    LocalSurface local(with);
    std::vector<client::ReceivedFrame> surfaces;
    for (std::size_t f = 0; f < frames.size(); ++f) {
        std::vector<ParticleArray> arrays;
        local.reconstruct(frames[f].view(arrays));
        surfaces.push_back(local.encoded(f, codec));
    }
    return surfaces;
}

Seen published(client::Client& client, const Settings& with, const std::vector<client::ReceivedFrame>& surfaces,
               std::uint32_t parts) {
    const std::string id = client::new_session_id();
    client.create_session(id, with);
    std::vector<client::Publisher> publishers;
    for (std::uint32_t p = 0; p < parts; ++p)
        publishers.push_back(client.publish(id, {.parts = parts, .part = p, .run = parts > 1 ? 0xbeefU : 0U}));
    Seen seen = watched(client, id, surfaces.size(), [&](std::size_t f) {
        const auto part = dealt(surfaces[f], parts, static_cast<unsigned>(31 * f + parts));
        for (std::uint32_t p = 0; p < parts; ++p) publishers[p].push(part[p]);
        for (client::Publisher& publisher : publishers) {
            const auto answer = publisher.next();
            EXPECT_TRUE(answer && answer->index == f);
        }
    });
    for (client::Publisher& publisher : publishers) publisher.finish();
    for (client::Publisher& publisher : publishers) EXPECT_FALSE(publisher.next());
    client.delete_session(id);
    return seen;
}

void expect_same(const Seen& seen, const Seen& expected, const std::string& what) {
    EXPECT_EQ(seen.fingerprints, expected.fingerprints) << what;
    ASSERT_EQ(seen.statistics.size(), expected.statistics.size());
    for (std::size_t f = 0; f < seen.statistics.size(); ++f) {
        const client::FrameStatistics& is = seen.statistics[f];
        const client::FrameStatistics& of_stream = expected.statistics[f];
        EXPECT_EQ(is.particles, of_stream.particles) << what << ", frame " << f;
        EXPECT_EQ(is.vertices, of_stream.vertices) << what << ", frame " << f;
        EXPECT_EQ(is.triangles, of_stream.triangles) << what << ", frame " << f;
        EXPECT_EQ(is.triangles_by_level, of_stream.triangles_by_level) << what << ", frame " << f;
        EXPECT_EQ(is.volume, of_stream.volume) << what << ", frame " << f;
        EXPECT_EQ(is.spray_particles, of_stream.spray_particles) << what << ", frame " << f;
    }
}

Settings smooth_and_fine() {
    Settings with = all_settings();
    with.cell_size = 0.5;
    return with;
}

Settings uniform() {
    Settings with = all_settings();
    with.mode = Mode::uniform;
    with.normals = false;
    return with;
}

TEST(PublishedSurfaces, AreThoseOfTheirParticlesInEveryFormFromAnyNumberOfPublishers) {
    ServerOptions options = test_options();
    options.limits.check_published = true;
    RunningServer running(options);
    const std::vector<Dealt> frames = all_frames();
    for (const Settings& with : {all_settings(), smooth_and_fine(), uniform()}) {
        const Seen expected = streamed(running.client, with, frames);
        for (const Codec codec : {Codec::lattice_packed, Codec::lattice_entropy}) {
            const auto surfaces = surfaces_of(with, frames, codec);
            for (const std::uint32_t parts : {1U, 2U, 3U, 8U})
                expect_same(published(running.client, with, surfaces, parts), expected,
                            std::string(name_of(codec)) + " from " + std::to_string(parts));
        }
    }
}

}  // namespace
}  // namespace meniscus::server::test
