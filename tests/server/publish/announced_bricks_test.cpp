// What a publisher announces bounds what its frame may take, before and while its messages are read.
#include <google/protobuf/io/coded_stream.h>
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>

#include "dealt_bricks.hpp"
#include "meniscus/error.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/intake/brick_reader.hpp"
#include "sessions/intake/frame_assembler.hpp"
#include "sessions/intake/frame_plan.hpp"
#include "sessions/sending/brick_messages.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {
namespace {

/// A frame as it comes over the wire.
struct Published {
    v1::PublishBegin begin;
    std::string bytes;

    void append(const std::string& message) {
        std::uint8_t length[5];
        const auto* const end = google::protobuf::io::CodedOutputStream::WriteVarint32ToArray(
            static_cast<std::uint32_t>(message.size()), static_cast<std::uint8_t*>(length));
        bytes.append(reinterpret_cast<const char*>(length), static_cast<std::size_t>(end - length));
        bytes += message;
        begin.set_byte_count(bytes.size());
    }
};

Published published_nothing(const Settings& with = settings()) {
    Published frame;
    frame.begin.mutable_mesh()->set_cell_size(world_cell_size(with));
    frame.begin.mutable_mesh()->set_offset_bits(offset_bits(with));
    frame.begin.mutable_mesh()->set_brick_cells(static_cast<std::uint32_t>(brick_cells));
    return frame;
}

Published published_surface() {
    LocalSurface local(settings());
    local.reconstruct(wave(12, 0.4).view());
    Published frame = published_nothing();
    v1::MeshBegin& mesh = *frame.begin.mutable_mesh();
    const client::ReceivedFrame encoded = local.encoded(0);
    for (const auto& brick : encoded.bricks) {
        const SharedBrick sent = brick_messages(*brick, {});
        for (const SharedMessage& message : sent->messages) frame.append(*message);
        mesh.set_brick_count(mesh.brick_count() + 1);
        mesh.set_triangle_count(mesh.triangle_count() + brick->triangles);
    }
    frame.begin.mutable_statistics()->set_triangles(mesh.triangle_count());
    return frame;
}

struct Reading {
    explicit Reading(std::size_t limit = 0, BrickReader::Check check = BrickReader::Check::each_brick)
        : account(std::make_shared<MemoryAccount>(limit)),
          reader(settings(), check, std::make_shared<WorkerPool>(1), account, stop) {}

    void read(const Published& frame) {
        InputFrame input(std::make_shared<MemoryAccount>());
        const FramePart part = FrameAssembler(limits, settings()).announce(frame.begin);
        begin_frame({&part, 1}, limits, input);
        std::memcpy(input.bytes.data(), frame.bytes.data(), frame.bytes.size());
        reader.read(input, result);
    }
    std::string refusal_of(const Published& frame) {
        try {
            read(frame);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return "none";
    }

    Limits limits;
    std::shared_ptr<MemoryAccount> account;
    std::shared_ptr<StopFlag> stop = std::make_shared<StopFlag>();
    BrickReader reader;
    ReconstructedFrame result;
};

std::string refusal_of_announcement(const Published& frame, const Settings& with = settings()) {
    try {
        static_cast<void>(brick_part(frame.begin, with));
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "none";
}

TEST(AnnouncedBricks, AreNoMoreThanTheirBytesCanHold) {
    Published frame = published_nothing();
    frame.begin.set_byte_count(1600);
    frame.begin.mutable_mesh()->set_brick_count(100);
    EXPECT_EQ(refusal_of_announcement(frame), "none");
    frame.begin.mutable_mesh()->set_brick_count(101);
    EXPECT_EQ(refusal_of_announcement(frame), "brick_count is 101, and byte_count 1600: a brick has at least 16 bytes");
}

TEST(AnnouncedBricks, HaveNoSprayWhereTheSettingsHaveNone) {
    Published frame = published_nothing();
    frame.begin.mutable_mesh()->set_spray_count(3);
    EXPECT_EQ(refusal_of_announcement(frame),
              "spray_count is 3, and the session's settings ask for none: spray is keep");
    Settings with = settings();
    with.spray = Spray::points;
    EXPECT_EQ(refusal_of_announcement(frame, with), "none");
}

TEST(AnnouncedBricks, HaveRangesOfTheirAttributesTypes) {
    Settings with = settings();
    with.all_attributes = true;
    const auto said = [&](v1::AttributeType type, double minimum, double maximum) {
        Published frame = published_nothing(with);
        frame.begin.set_byte_count(100);
        frame.begin.mutable_mesh()->set_brick_count(1);
        v1::MeshAttribute& attribute = *frame.begin.mutable_mesh()->add_attributes();
        attribute.set_name("a");
        attribute.set_type(type);
        attribute.set_components(1);
        attribute.set_bits(0);
        attribute.add_minimum(minimum);
        attribute.add_maximum(maximum);
        return refusal_of_announcement(frame, with);
    };
    EXPECT_EQ(said(v1::ATTRIBUTE_TYPE_UINT8, 0, 255), "none");
    EXPECT_EQ(said(v1::ATTRIBUTE_TYPE_UINT8, -5, 255), "attribute 'a' runs from -5 to 255, which is no range of uint8");
    EXPECT_EQ(said(v1::ATTRIBUTE_TYPE_INT32, -1e300, 0),
              "attribute 'a' runs from -1e+300 to 0, which is no range of int32");
    EXPECT_EQ(said(v1::ATTRIBUTE_TYPE_UINT32, 0, 4294967295.0), "none");
    EXPECT_EQ(said(v1::ATTRIBUTE_TYPE_FLOAT32, 0, 1e39),
              "attribute 'a' runs from 0 to 1e+39, which is no range of float32");
}

TEST(AnnouncedBricks, ComeFromABackendWhoseNameIsShortAndCanBeSeen) {
    Published frame = published_nothing();
    frame.begin.mutable_statistics()->set_backend("\x1b[2J" + std::string(1 << 20, 'x'));
    EXPECT_EQ(brick_part(frame.begin, settings()).statistics.backend.substr(0, 12), "\\u{001b}[2Jx");
    EXPECT_LT(brick_part(frame.begin, settings()).statistics.backend.size(), 64U);
}

TEST(AnnouncedBricks, AreRefusedWhereAMessageIsLongerThanAnyBrickNeeds) {
    Published frame = published_nothing();
    // Unknown fields of two bytes.
    std::string message;
    while (message.size() < 2'000'000) message += "\xf8\x01\x01";
    frame.append(message);
    const std::string said = Reading().refusal_of(frame);
    EXPECT_EQ(said.substr(0, 36), "the message at byte 0 has 2000001 by") << said;
}

TEST(AnnouncedBricks, CountOnceTheyAreParsedForAsLongAsTheyAreKept) {
    const Published frame = published_surface();
    Reading reading;
    reading.read(frame);
    reading.reader.release_memory();
    const std::size_t kept = reading.account->bytes();
    EXPECT_GE(kept, 2 * frame.bytes.size());
    reading.result.finished.reset();
    EXPECT_EQ(reading.account->bytes(), 0U);
    EXPECT_THROW(Reading(kept - 1).read(frame), LimitExceeded);
}

TEST(AnnouncedBricks, CountTheEdgesByWhichTheirSurfaceIsChecked) {
    const Published frame = published_surface();
    Reading without;
    without.read(frame);
    Reading with(0, BrickReader::Check::closed_surface);
    with.read(frame);
    EXPECT_GT(with.account->peak_bytes(), without.account->peak_bytes());
    with.reader.forget();
    with.result.finished.reset();
    EXPECT_EQ(with.account->bytes(), 0U);
}

TEST(AnnouncedBricks, AreReadNoFurtherOnceTheSessionIsToStop) {
    Reading reading;
    reading.stop->raise();
    EXPECT_THROW(reading.read(published_surface()), Stopped);
}

}  // namespace
}  // namespace meniscus::server::test
