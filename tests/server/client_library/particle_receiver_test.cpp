// The client library's reading of a server's particles: messages as they should be, and as they never should.
#include "receiving/particle_receiver.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <utility>

#include "conversion/particle_arrays.hpp"

namespace meniscus::client {
namespace {

using Response = v1::WatchParticlesResponse;

/// Two of four particles, with levels.
Response begin() {
    Response response;
    v1::ParticlesBegin& begin = *response.mutable_particles_begin();
    begin.set_frame_index(3);
    begin.set_particle_count(4);
    begin.set_stride(2);
    begin.set_sent_count(2);
    *begin.mutable_arrays() = conversion::particle_arrays(true, true);
    begin.set_particle_radius(0.5);
    begin.mutable_quantization_box()->mutable_min()->set_x(0.0);
    begin.mutable_quantization_box()->mutable_max()->set_x(1.0);
    return response;
}

Response chunk(std::string data) {
    Response response;
    response.mutable_frame_chunk()->set_data(std::move(data));
    return response;
}

Response end() {
    Response response;
    response.mutable_frame_end();
    return response;
}

const std::string positions("\1\0\2\0\3\0\4\0\5\0\6\1", 12);

TEST(ParticleReceiver, PutsPiecesTogetherWhereverTheyAreCut) {
    const std::string bytes = positions + std::string("\0\3", 2);
    for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
        ParticleReceiver receiver;
        EXPECT_FALSE(receiver.take(begin()));
        EXPECT_FALSE(receiver.take(chunk(bytes.substr(0, cut))));
        EXPECT_FALSE(receiver.take(chunk(bytes.substr(cut))));
        const auto particles = receiver.take(end());
        ASSERT_TRUE(particles);
        EXPECT_EQ(particles->quantized, (std::vector<std::uint16_t>{1, 2, 3, 4, 5, 262}));
        EXPECT_EQ(particles->levels, (std::vector<std::uint8_t>{0, 3}));
        receiver.end_of_stream();
    }
}

TEST(ParticleReceiver, SkipsAnArrayThatItDoesNotKnow) {
    Response response = begin();
    v1::ParticleArray& between = *response.mutable_particles_begin()->mutable_arrays(1);
    between.set_name("velocity");
    between.set_type(v1::ELEMENT_TYPE_FLOAT32);
    between.set_components(3);
    *response.mutable_particles_begin()->add_arrays() = conversion::particle_arrays(true, true)[1];
    ParticleReceiver receiver;
    EXPECT_FALSE(receiver.take(response));
    EXPECT_FALSE(receiver.take(chunk(positions + std::string(24, 'v') + std::string("\0\3", 2))));
    const auto particles = receiver.take(end());
    ASSERT_TRUE(particles);
    EXPECT_EQ(particles->quantized, (std::vector<std::uint16_t>{1, 2, 3, 4, 5, 262}));
    EXPECT_EQ(particles->levels, (std::vector<std::uint8_t>{0, 3}));
}

TEST(ParticleReceiver, ForgetsAFrameThatIsAbandoned) {
    ParticleReceiver receiver;
    receiver.take(begin());
    receiver.take(chunk("abc"));
    receiver.take(begin());
    receiver.take(chunk(positions + std::string(2, '\0')));
    EXPECT_TRUE(receiver.take(end()));
}

TEST(ParticleReceiver, RefusesWhatContradictsItself) {
    const auto changed = [](const std::function<void(v1::ParticlesBegin&)>& change) {
        Response response = begin();
        change(*response.mutable_particles_begin());
        return response;
    };
    struct Case {
        const char* words;
        std::vector<Response> messages;
    };
    const std::vector<Case> cases{
        {"outside of a frame", {chunk("a")}},
        {"had not begun", {end()}},
        {"kind that this version does not know", {Response()}},
        {"ended after 12 of 14 bytes", {begin(), chunk(positions), end()}},
        {"more bytes than the 14 announced", {begin(), chunk(std::string(15, 'a'))}},
        {"have the level 4", {begin(), chunk(positions + "\1\4"), end()}},
        {"are no 0-th part", {changed([](auto& b) { b.set_stride(0); })}},
        {"3 of 4 are no 2-th part", {changed([](auto& b) { b.set_sent_count(3); })}},
        {"more than memory can hold", {changed([](auto& b) {
             b.set_stride(1);
             b.set_particle_count(std::numeric_limits<std::uint64_t>::max());
             b.set_sent_count(std::numeric_limits<std::uint64_t>::max());
         })}},
        {"no arrays; the first must be 'position'", {changed([](auto& b) { b.clear_arrays(); })}},
        {"positions of float32; they must be of uint16",
         {changed([](auto& b) { b.mutable_arrays(0)->set_type(v1::ELEMENT_TYPE_FLOAT32); })}},
        {"array 'level' has the element type 9",
         {changed([](auto& b) { b.mutable_arrays(1)->set_type(static_cast<v1::ElementType>(9)); })}},
        {"have the radius nan",
         {changed([](auto& b) { b.set_particle_radius(std::numeric_limits<double>::quiet_NaN()); })}},
        {"needs both its corners", {changed([](auto& b) { b.mutable_quantization_box()->clear_max(); })}},
        {"a box from 0.000000 to -1.000000",
         {changed([](auto& b) { b.mutable_quantization_box()->mutable_max()->set_x(-1.0); })}},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(c.words);
        ParticleReceiver receiver;
        try {
            for (const Response& message : c.messages) receiver.take(message);
            FAIL() << "taken";
        } catch (const ServerError& error) {
            EXPECT_NE(std::string(error.what()).find(c.words), std::string::npos) << error.what();
        }
    }
    ParticleReceiver receiver;
    receiver.take(begin());
    EXPECT_THROW(receiver.end_of_stream(), ServerError);
}

TEST(ParticleReceiver, TakesNoMemoryForWhatIsOnlyAnnounced) {
    Response response = begin();
    response.mutable_particles_begin()->set_stride(1);
    response.mutable_particles_begin()->set_particle_count(std::uint64_t{1} << 59);
    response.mutable_particles_begin()->set_sent_count(std::uint64_t{1} << 59);
    ParticleReceiver receiver;
    EXPECT_FALSE(receiver.take(response));
}

}  // namespace
}  // namespace meniscus::client
