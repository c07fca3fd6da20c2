#include "sessions/intake/frame_assembler.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "conversion/particle_arrays.hpp"
#include "meniscus/error.hpp"
#include "whole_frames.hpp"

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
    test::WholeFrames assembler{limits};
    InputFrame frame{std::make_shared<MemoryAccount>(limits.bytes_per_session)};
};

TEST_F(FrameAssembly, PutsChunksTogetherWhereverTheyAreCut) {
    v1::FrameBegin message = begin(7, 3);
    *message.mutable_arrays() = conversion::particle_arrays(false, true);
    message.set_simulation_time(1.5);
    assembler.begin(message, frame);
    for (const std::size_t bytes : {1U, 0U, 30U, 8U}) assembler.append(chunk(bytes), frame);
    assembler.end();
    EXPECT_EQ(frame.index, 7U);
    EXPECT_EQ(frame.simulation_time, 1.5);
    EXPECT_EQ(frame.view().count(), 3U);
    EXPECT_EQ(frame.view().levels.size(), 3U);
    EXPECT_EQ(frame.view().levels[2], 'x');
    EXPECT_FALSE(assembler.in_frame());
}

TEST_F(FrameAssembly, TakesAnEmptyFrame) {
    assembler.begin(begin(0, 0), frame);
    assembler.end();
    EXPECT_EQ(frame.view().count(), 0U);
}

TEST_F(FrameAssembly, KeepsItsMemoryBetweenFrames) {
    assembler.begin(begin(0, 100), frame);
    const auto* memory = frame.bytes.data();
    assembler.append(chunk(1200), frame);
    assembler.end();
    assembler.begin(begin(1, 50), frame);
    EXPECT_EQ(frame.bytes.data(), memory);
}

TEST_F(FrameAssembly, RefusesACountPastTheLimitBeforeItAllocates) {
    EXPECT_THROW(assembler.begin(begin(0, 1001), frame), LimitExceeded);
    EXPECT_THROW(assembler.begin(begin(0, 501), frame), LimitExceeded);
    EXPECT_EQ(frame.bytes.capacity(), 0U);
}

TEST_F(FrameAssembly, RefusesACountWhoseBytesOverflowWithoutAnyLimit) {
    test::WholeFrames unlimited{Limits{}};
    EXPECT_THROW(unlimited.begin(begin(0, std::numeric_limits<std::uint64_t>::max()), frame), LimitExceeded);
}

TEST_F(FrameAssembly, RefusesIndicesThatDoNotIncrease) {
    assembler.begin(begin(5, 0), frame);
    assembler.end();
    EXPECT_THROW(assembler.begin(begin(5, 0), frame), InvalidInput);
    EXPECT_THROW(assembler.begin(begin(4, 0), frame), InvalidInput);
}

TEST_F(FrameAssembly, RefusesMessagesOutOfOrder) {
    EXPECT_THROW(assembler.append(chunk(1), frame), InvalidInput);
    EXPECT_THROW(assembler.end(), InvalidInput);
    assembler.begin(begin(0, 1), frame);
    EXPECT_THROW(assembler.begin(begin(1, 1), frame), InvalidInput);
    EXPECT_THROW(assembler.end_of_stream(), InvalidInput);
}

TEST_F(FrameAssembly, RefusesBytesThatDoNotMatchTheCount) {
    assembler.begin(begin(0, 1), frame);
    assembler.append(chunk(11), frame);
    EXPECT_THROW(assembler.end(), InvalidInput);
    EXPECT_THROW(assembler.append(chunk(2), frame), InvalidInput);
}

TEST_F(FrameAssembly, TakesAsManyChunksAsTheLimitSaysAndNoEmptyOneMore) {
    limits.chunks_per_frame = 3;
    test::WholeFrames limited{limits};
    for (std::uint64_t i = 0; i < 2; ++i) {
        limited.begin(begin(i, 1), frame);
        for (const std::size_t bytes : {0U, 0U, 12U}) limited.append(chunk(bytes), frame);
        limited.end();
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
    test::WholeFrames other{limits};
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

/// An array of three particles, the values of which count up from 0 in its own bytes.
struct SentArray {
    std::string name;
    v1::ElementType type;
    std::uint32_t components;
    std::size_t particle_bytes;
};

const SentArray sent_positions{"position", v1::ELEMENT_TYPE_FLOAT32, 3, 12};
const SentArray sent_levels{"level", v1::ELEMENT_TYPE_UINT8, 1, 1};
const SentArray sent_velocity{"velocity", v1::ELEMENT_TYPE_FLOAT32, 3, 12};
const SentArray sent_color{"color", v1::ELEMENT_TYPE_UINT8, 3, 3};
const SentArray sent_id{"id", v1::ELEMENT_TYPE_UINT32, 1, 4};
const SentArray sent_half{"half", v1::ELEMENT_TYPE_UINT16, 1, 2};

struct ArraysOfAFrame : FrameAssembly {
    static Settings naming(std::vector<std::string> names) {
        Settings settings;
        settings.attributes = std::move(names);
        return settings;
    }
    static v1::FrameBegin begin_of(const std::vector<SentArray>& arrays, std::uint64_t index = 0) {
        v1::FrameBegin message;
        message.set_frame_index(index);
        message.set_particle_count(3);
        for (const SentArray& array : arrays) {
            v1::ParticleArray& wire = *message.add_arrays();
            wire.set_name(array.name);
            wire.set_type(array.type);
            wire.set_components(array.components);
        }
        return message;
    }
    static std::string bytes_of(const SentArray& array) {
        std::string bytes(3 * array.particle_bytes, '\0');
        for (std::size_t i = 0; i < bytes.size(); ++i)
            bytes[i] = static_cast<char>(array.name[0] + static_cast<int>(i));
        return bytes;
    }
    /// In chunks of this size.
    void receive(test::WholeFrames& receiver, const std::vector<SentArray>& arrays, std::size_t size = 7) {
        receiver.begin(begin_of(arrays, next_index++), frame);
        std::string all;
        for (const SentArray& array : arrays) all += bytes_of(array);
        for (std::size_t at = 0; at < all.size(); at += size) {
            v1::FrameChunk message;
            message.set_data(all.substr(at, size));
            receiver.append(message, frame);
        }
        receiver.end();
        EXPECT_EQ(receiver.take_kept(), test::bytes_of(frame.view()));
    }
    std::string refusal(test::WholeFrames& receiver, const std::vector<SentArray>& arrays) {
        try {
            receiver.begin(begin_of(arrays, next_index), frame);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return {};
    }
    static std::string text(std::span<const std::byte> bytes) {
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }

    std::uint64_t next_index = 0;
};

TEST_F(ArraysOfAFrame, AreKeptWhereTheSettingsNameThemWhateverTheirOrderAndTheCuts) {
    test::WholeFrames receiver(limits, naming({"velocity", "color", "id"}));
    const std::vector<std::vector<SentArray>> orders{
        {sent_positions, sent_levels, sent_velocity, sent_half, sent_color, sent_id},
        {sent_positions, sent_half, sent_color, sent_id, sent_velocity, sent_levels},
        {sent_positions, sent_id, sent_velocity, sent_color}};
    for (const auto& arrays : orders)
        for (const std::size_t size : {std::size_t{1}, std::size_t{5}, std::size_t{1000}}) {
            receive(receiver, arrays, size);
            const ParticleFrame view = frame.view();
            EXPECT_EQ(text(std::as_bytes(view.positions)), bytes_of(sent_positions));
            EXPECT_EQ(view.levels.empty(), &arrays == &orders[2]);
            if (!view.levels.empty()) {
                EXPECT_EQ(text(std::as_bytes(view.levels)), bytes_of(sent_levels));
            }
            ASSERT_EQ(view.arrays.size(), 3U);
            for (const ParticleArray& array : view.arrays) {
                const auto sent = std::ranges::find(arrays, std::string(array.name), &SentArray::name);
                ASSERT_NE(sent, arrays.end());
                EXPECT_EQ(text(array.data), bytes_of(*sent)) << array.name;
                EXPECT_EQ(array.components, sent->components);
                EXPECT_EQ(reinterpret_cast<std::uintptr_t>(array.data.data()) % size_of(array.type), 0U) << array.name;
            }
        }
}

TEST_F(ArraysOfAFrame, OfPartsLieBehindEachOtherWhateverTheirOrderInEachPart) {
    const Settings named = naming({"velocity", "id"});
    const std::vector<std::vector<SentArray>> orders{{sent_positions, sent_velocity, sent_levels, sent_id},
                                                     {sent_positions, sent_id, sent_half, sent_velocity, sent_levels}};
    std::vector<FrameAssembler> assemblers(orders.size(), FrameAssembler(limits, named));
    std::vector<FramePart> parts;
    for (std::size_t p = 0; p < orders.size(); ++p) parts.push_back(assemblers[p].announce(begin_of(orders[p])));
    const auto pieces = begin_frame(parts, limits, frame);
    for (std::size_t p = orders.size(); p-- > 0;) {
        assemblers[p].place(parts[p], pieces[p]);
        v1::FrameChunk message;
        for (const SentArray& array : orders[p]) message.mutable_data()->append(bytes_of(array));
        assemblers[p].append(message, frame);
        assemblers[p].end();
    }
    const ParticleFrame view = frame.view();
    const auto twice = [](const SentArray& array) { return bytes_of(array) + bytes_of(array); };
    EXPECT_EQ(text(std::as_bytes(view.positions)), twice(sent_positions));
    EXPECT_EQ(text(std::as_bytes(view.levels)), twice(sent_levels));
    ASSERT_EQ(view.arrays.size(), 2U);
    EXPECT_EQ(text(view.arrays[0].data), twice(sent_velocity));
    EXPECT_EQ(text(view.arrays[1].data), twice(sent_id));
}

TEST_F(ArraysOfAFrame, AreThoseOfAllParts) {
    Settings all;
    all.all_attributes = true;
    const FrameAssembler receiver(limits, all);
    SentArray wide = sent_velocity;
    wide.components = 4;
    wide.particle_bytes = 16;
    const auto refusal_of = [&](const std::vector<SentArray>& first,
                                const std::vector<SentArray>& second) -> std::string {
        const std::vector<FramePart> parts{receiver.announce(begin_of(first)), receiver.announce(begin_of(second))};
        try {
            begin_frame(parts, limits, frame);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return {};
    };
    EXPECT_EQ(
        refusal_of({sent_positions, sent_velocity}, {sent_positions}),
        "frame 0: array 'velocity' of part 1 is missing, and float32 of 3 components in part 0; in all parts of a "
        "frame it is the same");
    EXPECT_EQ(
        refusal_of({sent_positions}, {sent_positions, sent_id}),
        "frame 0: array 'id' of part 1 is uint32 of 1 component, and missing in part 0; in all parts of a frame it "
        "is the same");
    EXPECT_EQ(
        refusal_of({sent_positions, sent_velocity}, {sent_positions, wide}),
        "frame 0: array 'velocity' of part 1 is float32 of 4 components, and float32 of 3 components in part 0; in "
        "all parts of a frame it is the same");
    EXPECT_EQ(refusal_of({sent_positions, sent_half}, {sent_positions}), "") << "no attribute is made of it";
}

TEST_F(ArraysOfAFrame, ThatAreNotNamedArePassedOverAndTakeNoMemory) {
    receive(assembler, {sent_positions, sent_velocity, sent_half, sent_id});
    EXPECT_EQ(frame.bytes.size(), 36U);
    EXPECT_TRUE(frame.view().arrays.empty());
    EXPECT_EQ(text(std::as_bytes(frame.view().positions)), bytes_of(sent_positions));
}

TEST_F(ArraysOfAFrame, AreAllKeptThatCanBeAttributesWhereTheSettingsSayAll) {
    Settings all;
    all.all_attributes = true;
    test::WholeFrames receiver(limits, all);
    receive(receiver, {sent_positions, sent_id, sent_half, sent_velocity});
    ASSERT_EQ(frame.view().arrays.size(), 2U);
    EXPECT_EQ(frame.view().arrays[0].name, "id");
    EXPECT_EQ(frame.view().arrays[1].name, "velocity");
}

TEST_F(ArraysOfAFrame, AreForgottenWithTheFrame) {
    test::WholeFrames receiver(limits, naming({"id"}));
    receive(receiver, {sent_positions, sent_id});
    InputFrame other{nullptr};
    other.take_from(frame);
    EXPECT_TRUE(frame.view().arrays.empty());
    ASSERT_EQ(other.view().arrays.size(), 1U);
    EXPECT_EQ(text(other.view().arrays[0].data), bytes_of(sent_id));
    EXPECT_EQ(other.view().arrays[0].name, "id");
    other.free_memory();
    EXPECT_TRUE(other.view().arrays.empty());
}

TEST_F(ArraysOfAFrame, AreRefusedByNameWhereOneIsMissingOrCannotBeAnAttribute) {
    test::WholeFrames receiver(limits, naming({"id", "velocity"}));
    EXPECT_EQ(refusal(receiver, {sent_positions, sent_id, sent_color}),
              "frame 0: no array 'velocity', which the session's settings name as an attribute; the frame's further "
              "arrays are 'id', 'color'");
    EXPECT_EQ(refusal(receiver, {sent_positions}),
              "frame 0: no array 'id', which the session's settings name as an attribute; the frame's further arrays "
              "are none beside positions and levels");
    SentArray pair = sent_velocity;
    pair.components = 2;
    EXPECT_EQ(refusal(receiver, {sent_positions, sent_id, pair}),
              "frame 0: array 'velocity' is float32 of 2 components, and the session's settings name it as an "
              "attribute; that is "
              "float32 or uint8 of 1, 3 or 4 components, or int32 or uint32 of 1");
    SentArray half = sent_half;
    half.name = "velocity";
    EXPECT_NE(refusal(receiver, {sent_positions, sent_id, half}).find("array 'velocity' is uint16 of 1 component, and"),
              std::string::npos);
    EXPECT_EQ(refusal(receiver, {sent_positions, sent_id, sent_velocity, sent_id}),
              "frame 0: array 'id' comes twice; each comes once");
    receive(receiver, {sent_positions, sent_velocity, sent_id});
    EXPECT_EQ(frame.view().arrays.size(), 2U) << "a refusal leaves nothing behind";
    v1::FrameBegin empty = begin_of({sent_positions}, next_index);
    empty.set_particle_count(0);
    EXPECT_NO_THROW(receiver.begin(empty, frame)) << "no particle lacks a value";
}

TEST_F(ArraysOfAFrame, CountToTheLimitOfBytesWhereTheyAreKept) {
    limits.bytes_per_session = 3 * (12 + 12) - 1;
    test::WholeFrames keeps(limits, naming({"velocity"}));
    EXPECT_THROW(keeps.begin(begin_of({sent_positions, sent_velocity}), frame), LimitExceeded);
    test::WholeFrames passes(limits);
    EXPECT_NO_THROW(passes.begin(begin_of({sent_positions, sent_velocity}), frame));
    EXPECT_EQ(passes.expected(), 72U);
}

TEST_F(ArraysOfAFrame, AreSixteenOfAMillionParticlesExactlyWithinTheLimit) {
    constexpr std::uint64_t count = 1'000'000;
    std::vector<SentArray> arrays{sent_positions};
    std::vector<std::string> names;
    for (int i = 0; i < 16; ++i) {
        names.push_back("a" + std::to_string(i));
        arrays.push_back({names.back(), v1::ELEMENT_TYPE_FLOAT32, 4, 16});
    }
    v1::FrameBegin message = begin_of(arrays);
    message.set_particle_count(count);
    Limits exact{.bytes_per_session = count * (12 + 16 * 16)};
    InputFrame large{nullptr};
    test::WholeFrames receiver(exact, naming(names));
    receiver.begin(message, large);
    EXPECT_EQ(large.bytes.size(), exact.bytes_per_session);
    EXPECT_EQ(large.view().arrays.size(), 16U);
    --exact.bytes_per_session;
    test::WholeFrames limited(exact, naming(names));
    EXPECT_THROW(limited.begin(message, large), LimitExceeded);
}

TEST_F(ArraysOfAFrame, CannotOverflowByArraysThatArePassedOver) {
    test::WholeFrames unlimited{Limits{}};
    v1::FrameBegin message = begin_of({sent_positions, {"wide", v1::ELEMENT_TYPE_FLOAT32, 16, 64}});
    message.set_particle_count(std::numeric_limits<std::int64_t>::max() / 70);
    EXPECT_THROW(unlimited.begin(message, frame), LimitExceeded);
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
