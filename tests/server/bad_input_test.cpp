// What a simulator can get wrong: the status it gets, and that the session lives on.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "meniscus/error.hpp"
#include "running_server.hpp"

namespace meniscus::server::test {
namespace {

constexpr auto invalid = grpc::StatusCode::INVALID_ARGUMENT;
constexpr auto exhausted = grpc::StatusCode::RESOURCE_EXHAUSTED;

struct BadInput : testing::Test {
    static ServerOptions options() {
        ServerOptions options = test_options();
        options.limits.particles_per_frame = 10000;
        return options;
    }

    /// Sends one good frame, then what is bad.
    void expect(grpc::StatusCode code, const std::string& words, const std::function<void(RawStream&)>& send_bad) {
        const std::string id = running.session();
        RawStream stream(running.server.address(), id);
        stream.send_begin(10, 0);
        stream.send_end();
        send_bad(stream);
        const grpc::Status status = stream.finish();
        EXPECT_EQ(status.error_code(), code) << status.error_message();
        EXPECT_NE(status.error_message().find(words), std::string::npos) << status.error_message();
        EXPECT_EQ(stream.answered, 1);
        expect_usable(id);
    }

    /// A new stream may be opened at once, and gives the right mesh.
    void expect_usable(const std::string& id) {
        auto stream = running.client.stream(id);
        const Particles particles = wave(5, 0.0);
        stream.push(particles.view(), 11, 0.0);
        const auto frame = stream.next();
        ASSERT_TRUE(frame);
        EXPECT_EQ(mesh_sha256(frame->mesh()), local_sha256(particles));
    }

    static v1::StreamRequest begin(std::uint64_t particles) {
        v1::StreamRequest request;
        request.mutable_frame_begin()->set_frame_index(11);
        request.mutable_frame_begin()->set_particle_count(particles);
        return request;
    }
    static v1::StreamRequest begin_quantized(double min_x, double max_x) {
        v1::StreamRequest request = begin(1);
        v1::FrameBegin& message = *request.mutable_frame_begin();
        message.set_encoding(v1::POSITION_ENCODING_UINT16);
        message.mutable_quantization_box()->mutable_min()->set_x(min_x);
        message.mutable_quantization_box()->mutable_max()->set_x(max_x);
        return request;
    }

    RunningServer running{options()};
};

TEST_F(BadInput, FewerBytesThanTheCountSays) {
    expect(invalid, "frame 11: 119 bytes for 10 particles; 120 were announced", [](RawStream& s) {
        s.send_begin(11, 10);
        s.send_chunk(119);
        s.send_end();
    });
}

TEST_F(BadInput, MoreBytesThanTheCountSays) {
    expect(invalid, "121 bytes", [](RawStream& s) {
        s.send_begin(11, 10);
        s.send_chunk(121);
    });
}

TEST_F(BadInput, AChunkOverOneMebibyte) {
    expect(invalid, "1048577", [](RawStream& s) {
        s.send_begin(11, 10000);
        s.send_chunk(chunk_bytes + 1);
    });
}

TEST_F(BadInput, ACountPastTheParticleLimit) {
    expect(exhausted, "10001 particles; the server takes at most 10000", [](RawStream& s) { s.send_begin(11, 10001); });
}

TEST_F(BadInput, AnAbsurdCount) {
    expect(exhausted, "18446744073709551615",
           [](RawStream& s) { s.send_begin(11, std::numeric_limits<std::uint64_t>::max()); });
}

TEST_F(BadInput, TheSameFrameIndexTwice) {
    expect(invalid, "frame index 10 after 10", [](RawStream& s) { s.send_begin(10, 0); });
}

TEST_F(BadInput, AFrameIndexThatGoesBack) {
    expect(invalid, "frame index 9 after 10", [](RawStream& s) { s.send_begin(9, 0); });
}

TEST_F(BadInput, AChunkOutsideOfAFrame) {
    expect(invalid, "outside of a frame", [](RawStream& s) { s.send_chunk(12); });
}

TEST_F(BadInput, AFrameEndOutsideOfAFrame) {
    expect(invalid, "outside of a frame", [](RawStream& s) { s.send_end(); });
}

TEST_F(BadInput, AFrameWithinAFrame) {
    expect(invalid, "frame 12 begins before frame 11 has ended", [](RawStream& s) {
        s.send_begin(11, 1);
        s.send_begin(12, 1);
    });
}

TEST_F(BadInput, AStreamThatEndsWithinAFrame) {
    expect(invalid, "ended within frame 11, after 5 of 12 bytes", [](RawStream& s) {
        s.send_begin(11, 1);
        s.send_chunk(5);
        s.call->WritesDone();
    });
}

TEST_F(BadInput, ASecondOpen) {
    expect(invalid, "a second open", [](RawStream& s) {
        v1::StreamRequest request;
        request.mutable_open();
        s.call->Write(request);
    });
}

TEST_F(BadInput, AMessageWithoutAKind) {
    expect(invalid, "does not know", [](RawStream& s) { s.call->Write({}); });
}

TEST_F(BadInput, ATimeThatIsNotFinite) {
    expect(invalid, "simulation_time is inf", [](RawStream& s) {
        auto request = begin(1);
        request.mutable_frame_begin()->set_simulation_time(std::numeric_limits<double>::infinity());
        s.call->Write(request);
    });
}

TEST_F(BadInput, AnUnknownPositionEncoding) {
    expect(invalid, "encoding has the value 5", [](RawStream& s) {
        auto request = begin(1);
        request.mutable_frame_begin()->set_encoding(static_cast<v1::PositionEncoding>(5));
        s.call->Write(request);
    });
}

TEST_F(BadInput, AMissingQuantizationBox) {
    expect(invalid, "needs a quantization_box", [](RawStream& s) {
        auto request = begin(1);
        request.mutable_frame_begin()->set_encoding(v1::POSITION_ENCODING_UINT16);
        s.call->Write(request);
    });
}

TEST_F(BadInput, AQuantizationBoxThatIsNotFinite) {
    expect(invalid, "must be finite",
           [](RawStream& s) { s.call->Write(begin_quantized(0.0, std::numeric_limits<double>::quiet_NaN())); });
}

TEST_F(BadInput, AnInvertedQuantizationBox) {
    expect(invalid, "from 2 to 1 on the x axis", [](RawStream& s) { s.call->Write(begin_quantized(2.0, 1.0)); });
}

TEST_F(BadInput, APositionThatIsNotFinite) {
    expect(invalid, "frame 11", [](RawStream& s) {
        s.send_begin(11, 1);
        v1::StreamRequest request;
        request.mutable_frame_chunk()->set_data(std::string(12, '\xff'));  // NaN
        s.call->Write(request);
        s.send_end();
    });
}

TEST_F(BadInput, AParticleLevelAboveThree) {
    expect(invalid, "frame 11", [](RawStream& s) {
        auto request = begin(1);
        request.mutable_frame_begin()->set_has_levels(true);
        s.call->Write(request);
        v1::StreamRequest data;
        data.mutable_frame_chunk()->set_data(std::string(12, '\0') + '\x04');
        s.call->Write(data);
        s.send_end();
    });
}

TEST_F(BadInput, AFirstMessageThatIsNotOpen) {
    const std::string id = running.session();
    RawStream stream(running.server.address(), id, false);
    stream.send_begin(0, 0);
    EXPECT_EQ(stream.finish().error_code(), invalid);
    expect_usable(id);
}

TEST_F(BadInput, AStreamWithoutAnyMessage) {
    const std::string id = running.session();
    RawStream stream(running.server.address(), id, false);
    stream.call->WritesDone();
    EXPECT_EQ(stream.finish().error_code(), invalid);
}

TEST_F(BadInput, NormalBitsOutOfRange) {
    const std::string id = running.session();
    auto stream = running.client.stream(id, {.normal_bits = 17});
    EXPECT_THROW(stream.next(), InvalidInput);
    auto watcher = running.client.watch(id, 1);
    EXPECT_THROW(watcher.next(), InvalidInput);
    expect_usable(id);
}

TEST_F(BadInput, NoSessionIdInTheMetadata) {
    RawStream stream(running.server.address());
    EXPECT_EQ(stream.finish().error_code(), invalid);
}

TEST_F(BadInput, AnotherSessionIdInTheMetadata) {
    const std::string id = running.session();
    RawStream stream(running.server.address(), running.session(), false);
    stream.send_open(id);
    EXPECT_EQ(stream.finish().error_code(), invalid);
    expect_usable(id);
}

TEST_F(BadInput, ASessionIdThatIsNoUuid) {
    RawStream stream(running.server.address(), "ABCDEF00-0000-4000-8000-000000000000");
    EXPECT_EQ(stream.finish().error_code(), invalid);
}

TEST_F(BadInput, ASessionThatDoesNotExist) {
    RawStream stream(running.server.address(), client::new_session_id());
    EXPECT_EQ(stream.finish().error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST_F(BadInput, ReachesTheCallerOfPushAndNextAsItsException) {
    const std::string id = running.session();
    auto stream = running.client.stream(id);
    Particles bad = wave(3, 0.0);
    bad.positions[7] = std::numeric_limits<float>::quiet_NaN();
    stream.push(bad.view(), 0, 0.0);
    EXPECT_THROW(stream.next(), InvalidInput);
    EXPECT_THROW(stream.push(wave(3, 0.0).view(), 1, 0.0), InvalidInput);
    auto large = running.client.stream(id, {});
    EXPECT_THROW(
        {
            large.push(wave(22, 0.0).view(), 0, 0.0);
            large.next();
        },
        LimitExceeded);
    expect_usable(id);
}

TEST(MemoryLimit, RefusesAFrameThatWouldPassIt) {
    ServerOptions options = test_options();
    options.limits.bytes_per_session = 1000;
    RunningServer running(options);
    const std::string id = running.session();
    RawStream stream(running.server.address(), id);
    stream.send_begin(0, 84);
    const grpc::Status status = stream.finish();
    EXPECT_EQ(status.error_code(), exhausted);
    EXPECT_NE(status.error_message().find("at most 1000 bytes"), std::string::npos) << status.error_message();
}

TEST(MemoryLimit, RefusesAReconstructionThatWouldPassItAndLivesOn) {
    ServerOptions options = test_options();
    options.limits.bytes_per_session = 200'000;
    RunningServer running(options);
    const std::string id = running.session();
    for (int round = 0; round < 2; ++round) {
        auto stream = running.client.stream(id);
        stream.push(wave(20, 0.0).view(), 0, 0.0);
        EXPECT_THROW(stream.next(), LimitExceeded);
    }
    auto stream = running.client.stream(id);
    stream.push({}, 0, 0.0);
    EXPECT_TRUE(stream.next());
}

}  // namespace
}  // namespace meniscus::server::test
