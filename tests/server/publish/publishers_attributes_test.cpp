// Published surfaces have the attributes of their session, as streams of particles do: all parts with bricks the same,
// and every frame what the first one brought.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "attribute_frames.hpp"
#include "dealt_bricks.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh_hash.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

constexpr std::size_t publisher_count = 3;

Settings of_all() {
    Settings with = settings();
    with.all_attributes = true;
    return with;
}

client::ReceivedFrame surface(const Settings& with, std::uint64_t index, const std::vector<std::string>& arrays) {
    const ParticlesWithArrays particles(wave(12, 0.1 * static_cast<double>(index)));
    ParticleFrame frame = particles.view();
    std::vector<ParticleArray> chosen;
    for (const ParticleArray& array : particles.arrays)
        if (std::ranges::find(arrays, array.name) != arrays.end()) chosen.push_back(array);
    frame.arrays = chosen;
    LocalSurface local(with);
    local.reconstruct(frame);
    return local.encoded(index);
}

/// As a process has it that knows of no particles.
client::ReceivedFrame nothing(const Settings& with, std::uint64_t index) {
    LocalSurface local(with);
    local.reconstruct({});
    client::ReceivedFrame frame = local.encoded(index);
    EXPECT_TRUE(frame.bricks.empty());
    EXPECT_TRUE(frame.attributes.empty());
    return frame;
}

struct PublishersAttributes : testing::Test {
    RunningServer running;

    std::string session(const Settings& with) {
        std::string id = client::new_session_id();
        running.client.create_session(id, with);
        return id;
    }
    /// One frame from several publishers, each with its own.
    void publish(const std::string& id, std::uint64_t run, const std::vector<client::ReceivedFrame>& frames) {
        std::vector<std::thread> publishers;
        for (std::uint32_t p = 0; p < frames.size(); ++p)
            publishers.emplace_back([&, p] {
                auto publisher = running.client.publish(
                    id, {.parts = static_cast<std::uint32_t>(frames.size()), .part = p, .run = run});
                publisher.push(frames[p]);
                publisher.finish();
                const auto answer = publisher.next();
                EXPECT_TRUE(answer && answer->index == frames[p].index);
                EXPECT_FALSE(publisher.next());
            });
        for (std::thread& publisher : publishers) publisher.join();
    }
    client::ReceivedFrame shown(const std::string& id) {
        auto frame = running.client.snapshot(id, {.attributes = all_exact});
        EXPECT_TRUE(frame);
        return frame.value_or(client::ReceivedFrame());
    }
};

TEST_F(PublishersAttributes, NeedNotBeNamedByThoseWithoutBricks) {
    const std::vector<std::string> names{"velocity", "id"};
    for (const Settings& with : {settings_with(names), of_all()}) {
        const std::string id = session(with);
        std::uint64_t index = 0;
        const auto frame_of = [&](std::size_t owner) {
            std::vector<client::ReceivedFrame> frames(publisher_count, nothing(with, index));
            if (owner < publisher_count) frames[owner] = surface(with, index, names);
            return frames;
        };
        // None has any; one of them has all; some have some.
        publish(id, index + 1, frame_of(publisher_count));
        EXPECT_TRUE(shown(id).bricks.empty());
        for (std::size_t owner = 0; owner < publisher_count; ++owner) {
            ++index;
            const client::ReceivedFrame whole = surface(with, index, names);
            publish(id, index + 1, frame_of(owner));
            EXPECT_EQ(mesh_sha256(shown(id).mesh()), mesh_sha256(whole.mesh()));
            EXPECT_EQ(attributes_of(in_canonical_order(shown(id).mesh())),
                      attributes_of(in_canonical_order(whole.mesh())));
        }
        std::mt19937 random(1);
        for (unsigned parts = 2; parts <= 10; ++parts) {
            ++index;
            const client::ReceivedFrame whole = surface(with, index, names);
            std::vector<client::ReceivedFrame> deal = dealt(whole, parts - 1, parts);
            for (client::ReceivedFrame& frame : deal)
                if (frame.bricks.empty() && random() % 2 == 0) frame = nothing(with, index);
            const auto place = static_cast<std::ptrdiff_t>(random() % parts);
            deal.insert(deal.begin() + place, nothing(with, index));
            publish(id, index + 1, deal);
            EXPECT_EQ(mesh_sha256(shown(id).mesh()), mesh_sha256(whole.mesh())) << parts;
            EXPECT_EQ(attributes_of(in_canonical_order(shown(id).mesh())),
                      attributes_of(in_canonical_order(whole.mesh())))
                << parts;
        }
        ++index;
        publish(id, index + 1, frame_of(publisher_count));
        EXPECT_TRUE(shown(id).bricks.empty());
        EXPECT_EQ(shown(id).attributes.size(), names.size());
    }
}

TEST_F(PublishersAttributes, AreThoseOfTheFirstFrameThatHasAny) {
    const std::string id = session(of_all());
    {
        auto publisher = running.client.publish(id);
        publisher.push(surface(of_all(), 0, {}));
        publisher.push(surface(of_all(), 1, {"id", "color"}));
        publisher.push(nothing(of_all(), 2));
        for (std::uint64_t i = 0; i < 3; ++i) {
            const auto answer = publisher.next();
            ASSERT_TRUE(answer && answer->index == i);
        }
        EXPECT_EQ(shown(id).attributes.size(), 2U);
    }
    struct Case {
        std::vector<std::string> names;
        std::string said;
    };
    const std::string before =
        "must be as in the frames before: 'color', uint8 of 3 components; 'id', uint32 of 1 component";
    for (const Case& wrong : {Case{{}, "the attributes are none, " + before},
                              Case{{"id"}, "the attributes are 'id', uint32 of 1 component, " + before}}) {
        auto publisher = running.client.publish(id);
        publisher.push(surface(of_all(), 3, wrong.names));
        std::string said;
        try {
            publisher.next();
        } catch (const InvalidInput& error) {
            said = error.what();
        }
        EXPECT_NE(said.find(wrong.said), std::string::npos) << said;
    }
}

TEST_F(PublishersAttributes, KeepTheirTypes) {
    const Settings with = settings_with({"id"});
    const std::string id = session(with);
    auto publisher = running.client.publish(id);
    publisher.push(surface(with, 0, {"id"}));
    ASSERT_TRUE(publisher.next());
    Particles particles = wave(6, 0.0);
    const std::vector<float> values(particles.positions.size() / 3, 1.5F);
    const ParticleArray array{"id", std::as_bytes(std::span(values))};
    ParticleFrame frame = particles.view();
    frame.arrays = std::span(&array, 1);
    LocalSurface local(with);
    local.reconstruct(frame);
    publisher.push(local.encoded(1));
    std::string said;
    try {
        publisher.next();
    } catch (const InvalidInput& error) {
        said = error.what();
    }
    EXPECT_NE(said.find("'id', float32 of 1 component, must be as in the frames before: 'id', uint32 of 1 component"),
              std::string::npos)
        << said;
}

TEST_F(PublishersAttributes, OfAStreamAreThoseOfTheFirstFrameThatBringsAnyToo) {
    const std::string id = session(of_all());
    const ParticlesWithArrays particles(wave(6, 0.0));
    auto stream = running.client.stream(id, {.receive_meshes = false});
    stream.push(particles.particles.view(), 0, 0.0);
    ASSERT_TRUE(stream.next());
    EXPECT_TRUE(shown(id).attributes.empty());
    stream.push(particles.view(), 1, 0.0);
    ASSERT_TRUE(stream.next());
    EXPECT_EQ(shown(id).attributes.size(), 3U);
    stream.push(particles.particles.view(), 2, 0.0);
    EXPECT_THROW(stream.next(), InvalidInput);
}

}  // namespace
}  // namespace meniscus::server::test
