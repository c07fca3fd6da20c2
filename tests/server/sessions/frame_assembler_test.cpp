#include "sessions/frame_assembler.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "conversion/particle_arrays.hpp"
#include "meniscus/error.hpp"

namespace meniscus::server {
namespace {

struct FrameAssembly : testing::Test {
    v1::FrameBegin begin(std::uint64_t index, std::uint64_t count) const {
        v1::FrameBegin message;
        message.set_frame_index(index);
        message.set_particle_count(count);
        *message.mutable_arrays() = conversion::particle_arrays(false, false);
        return message;
    }
    v1::FrameBegin begin_quantized(double min, double max) const {
        v1::FrameBegin message = begin(0, 1);
        *message.mutable_arrays() = conversion::particle_arrays(true, false);
        for (auto* corner :
             {message.mutable_quantization_box()->mutable_min(), message.mutable_quantization_box()->mutable_max()}) {
            corner->set_x(0);
            corner->set_y(0);
            corner->set_z(0);
        }
        message.mutable_quantization_box()->mutable_min()->set_y(min);
        message.mutable_quantization_box()->mutable_max()->set_y(max);
        return message;
    }
    v1::FrameChunk chunk(std::size_t bytes, char value = 'x') const {
        v1::FrameChunk message;
        message.set_data(std::string(bytes, value));
        return message;
    }

    Limits limits{.particles_per_frame = 1000, .bytes_per_session = 6000};
    FrameAssembler assembler{limits};
    InputFrame frame{std::make_shared<MemoryAccount>(limits.bytes_per_session)};
};

TEST_F(FrameAssembly, PutsChunksTogetherWhereverTheyAreCut) {
    v1::FrameBegin message = begin(7, 3);
    *message.mutable_arrays() = conversion::particle_arrays(false, true);
    message.set_simulation_time(1.5);
    assembler.begin(message, frame);
    for (const std::size_t bytes : {1U, 0U, 30U, 8U}) assembler.append(chunk(bytes), frame);
    assembler.end(frame);
    EXPECT_EQ(frame.index, 7U);
    EXPECT_EQ(frame.simulation_time, 1.5);
    EXPECT_EQ(frame.view().count(), 3U);
    EXPECT_EQ(frame.view().levels.size(), 3U);
    EXPECT_EQ(frame.view().levels[2], 'x');
    EXPECT_FALSE(assembler.in_frame());
}

TEST_F(FrameAssembly, TakesAnEmptyFrame) {
    assembler.begin(begin(0, 0), frame);
    assembler.end(frame);
    EXPECT_EQ(frame.view().count(), 0U);
}

TEST_F(FrameAssembly, KeepsItsMemoryBetweenFrames) {
    assembler.begin(begin(0, 100), frame);
    const auto* memory = frame.bytes.data();
    assembler.append(chunk(1200), frame);
    assembler.end(frame);
    assembler.begin(begin(1, 50), frame);
    EXPECT_EQ(frame.bytes.data(), memory);
}

TEST_F(FrameAssembly, RefusesACountPastTheLimitBeforeItAllocates) {
    EXPECT_THROW(assembler.begin(begin(0, 1001), frame), LimitExceeded);
    EXPECT_THROW(assembler.begin(begin(0, 501), frame), LimitExceeded);
    EXPECT_EQ(frame.bytes.capacity(), 0U);
}

TEST_F(FrameAssembly, RefusesACountWhoseBytesOverflowWithoutAnyLimit) {
    FrameAssembler unlimited{Limits{}};
    EXPECT_THROW(unlimited.begin(begin(0, std::numeric_limits<std::uint64_t>::max()), frame), LimitExceeded);
}

TEST_F(FrameAssembly, RefusesIndicesThatDoNotIncrease) {
    assembler.begin(begin(5, 0), frame);
    assembler.end(frame);
    EXPECT_THROW(assembler.begin(begin(5, 0), frame), InvalidInput);
    EXPECT_THROW(assembler.begin(begin(4, 0), frame), InvalidInput);
}

TEST_F(FrameAssembly, RefusesMessagesOutOfOrder) {
    EXPECT_THROW(assembler.append(chunk(1), frame), InvalidInput);
    EXPECT_THROW(assembler.end(frame), InvalidInput);
    assembler.begin(begin(0, 1), frame);
    EXPECT_THROW(assembler.begin(begin(1, 1), frame), InvalidInput);
    EXPECT_THROW(assembler.end_of_stream(), InvalidInput);
}

TEST_F(FrameAssembly, RefusesBytesThatDoNotMatchTheCount) {
    assembler.begin(begin(0, 1), frame);
    assembler.append(chunk(11), frame);
    EXPECT_THROW(assembler.end(frame), InvalidInput);
    EXPECT_THROW(assembler.append(chunk(2), frame), InvalidInput);
}

TEST_F(FrameAssembly, TakesAsManyChunksAsTheLimitSaysAndNoEmptyOneMore) {
    limits.chunks_per_frame = 3;
    FrameAssembler limited{limits};
    for (std::uint64_t i = 0; i < 2; ++i) {
        limited.begin(begin(i, 1), frame);
        for (const std::size_t bytes : {0U, 0U, 12U}) limited.append(chunk(bytes), frame);
        limited.end(frame);
    }
    limited.begin(begin(2, 1), frame);
    for (const std::size_t bytes : {0U, 0U, 11U}) limited.append(chunk(bytes), frame);
    EXPECT_THROW(limited.append(chunk(0), frame), LimitExceeded);
}

TEST_F(FrameAssembly, RefusesAFrameOfMoreBytesThanMayEverBeInFlight) {
    const auto in_flight = std::make_shared<BytesInFlight>(1200, 4);
    InputFrame first{nullptr, in_flight};
    InputFrame second{nullptr, in_flight};
    assembler.begin(begin(0, 100), first);
    EXPECT_LT(in_flight->bytes(), 1200U) << "what is announced has not arrived";
    FrameAssembler other{limits};
    EXPECT_THROW(other.begin(begin(0, 101), second), LimitExceeded);
    other.begin(begin(1, 5), second);
    EXPECT_EQ(in_flight->bytes(), 60U);
    second.land();
    EXPECT_EQ(in_flight->bytes(), 0U);
}

TEST_F(FrameAssembly, RefusesATimeThatIsNotFinite) {
    v1::FrameBegin message = begin(0, 1);
    message.set_simulation_time(std::nan(""));
    EXPECT_THROW(assembler.begin(message, frame), InvalidInput);
}

TEST_F(FrameAssembly, RefusesAnArrayThatItDoesNotKnow) {
    v1::FrameBegin message = begin(0, 1);
    *message.add_arrays() = message.arrays(0);
    message.mutable_arrays(1)->set_name("velocity");
    EXPECT_THROW(assembler.begin(message, frame), InvalidInput);
}

TEST_F(FrameAssembly, RefusesAQuantizationBoxThatIsMissingNotFiniteOrInverted) {
    v1::FrameBegin none = begin(0, 1);
    *none.mutable_arrays() = conversion::particle_arrays(true, false);
    EXPECT_THROW(assembler.begin(none, frame), InvalidInput);
    v1::FrameBegin half = none;
    half.mutable_quantization_box()->mutable_min();
    EXPECT_THROW(assembler.begin(half, frame), InvalidInput);
    EXPECT_THROW(assembler.begin(begin_quantized(0.0, std::numeric_limits<double>::infinity()), frame), InvalidInput);
    EXPECT_THROW(assembler.begin(begin_quantized(1.0, 0.0), frame), InvalidInput);
    EXPECT_NO_THROW(assembler.begin(begin_quantized(1.0, 1.0), frame));
}

TEST_F(FrameAssembly, NamesValueAndLimit) {
    try {
        assembler.begin(begin(3, 1001), frame);
        FAIL();
    } catch (const LimitExceeded& error) {
        EXPECT_STREQ(error.what(), "frame 3: 1001 particles; the server takes at most 1000 per frame");
    }
}

}  // namespace
}  // namespace meniscus::server
