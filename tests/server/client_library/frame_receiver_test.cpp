// A server that lies is found out.
#include "receiving/frame_receiver.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "conversion/attribute_conversion.hpp"
#include "conversion/spray_conversion.hpp"
#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::client {
namespace {

v1::StreamResponse begin(std::uint32_t bricks, std::uint64_t triangles = 0, std::uint64_t index = 3) {
    v1::StreamResponse response;
    v1::MeshBegin& message = *response.mutable_mesh_begin();
    message.set_frame_index(index);
    message.set_triangle_count(triangles);
    message.set_cell_size(0.1);
    message.set_offset_bits(6);
    message.set_brick_cells(brick_cells);
    message.set_brick_count(bricks);
    return response;
}

v1::StreamResponse brick(int x, std::uint32_t part = 0, std::uint32_t parts = 1) {
    v1::StreamResponse response;
    v1::MeshBrick& message = *response.mutable_mesh_brick();
    message.set_x(x);
    message.set_triangle_count(2);
    message.set_data(std::string(1, static_cast<char>('a' + part)));
    message.set_codec(v1::CODEC_DRACO);
    message.set_part_index(part);
    message.set_part_count(parts);
    return response;
}

v1::StreamResponse statistics(std::uint64_t triangles, std::uint64_t index = 3) {
    v1::StreamResponse response;
    response.mutable_frame_statistics()->set_frame_index(index);
    response.mutable_frame_statistics()->set_triangles(triangles);
    return response;
}

TEST(FrameReceiver, PutsPartsAndBricksTogether) {
    FrameReceiver receiver(true);
    EXPECT_FALSE(receiver.take(begin(2, 4)));
    for (std::uint32_t part = 0; part < 3; ++part) EXPECT_FALSE(receiver.take(brick(0, part, 3)));
    EXPECT_FALSE(receiver.take(brick(1)));
    const auto frame = receiver.take(statistics(4));
    ASSERT_TRUE(frame);
    ASSERT_EQ(frame->bricks.size(), 2U);
    EXPECT_EQ(frame->bricks[0]->data, (std::vector<std::byte>{std::byte{'a'}, std::byte{'b'}, std::byte{'c'}}));
    receiver.end_of_stream();
}

v1::StreamResponse spray(std::initializer_list<Point> points) {
    v1::StreamResponse response;
    *response.mutable_spray_points() = conversion::to_wire(std::vector<Point>(points)).at(0);
    return response;
}

/// Without bricks.
v1::StreamResponse begin_with_spray(std::uint64_t count, std::uint64_t index = 3) {
    v1::StreamResponse response = begin(0, 0, index);
    response.mutable_mesh_begin()->set_spray_count(count);
    return response;
}

TEST(FrameReceiver, HasTheSprayOfTheFrameItself) {
    FrameReceiver receiver(true, true);
    receiver.take(begin_with_spray(3));
    receiver.take(spray({{1, 2, 3}, {4, 5, 6}}));
    receiver.take(spray({{7, 8, 9}}));
    const auto frame = receiver.take(statistics(0));
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->spray, (std::vector<Point>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
    const Mesh mesh = frame->mesh();
    EXPECT_EQ(std::vector<Point>(mesh.spray.begin(), mesh.spray.end()), frame->spray);
    receiver.take(begin_with_spray(0, 4));
    EXPECT_TRUE(receiver.take(statistics(0, 4))->spray.empty());
}

TEST(FrameReceiver, HasNoSprayThatWasNotAskedFor) {
    FrameReceiver receiver(true);
    receiver.take(begin_with_spray(3));
    EXPECT_TRUE(receiver.take(statistics(0))->spray.empty());
}

TEST(FrameReceiver, RefusesSprayThatContradictsItsAnnouncement) {
    FrameReceiver receiver(true, true);
    EXPECT_THROW(receiver.take(spray({{1, 2, 3}})), ServerError) << "outside of a frame";
    receiver.take(begin_with_spray(2));
    receiver.take(spray({{1, 2, 3}}));
    EXPECT_THROW(receiver.take(statistics(0)), ServerError) << "too little";
    receiver.take(begin_with_spray(2));
    EXPECT_THROW(receiver.take(spray({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}})), ServerError) << "too much";
    receiver.take(begin_with_spray(2));
    v1::StreamResponse cut;
    cut.mutable_spray_points()->set_positions("eleven chars");
    cut.mutable_spray_points()->mutable_positions()->pop_back();
    EXPECT_THROW(receiver.take(cut), ServerError) << "no whole point";
}

TEST(FrameReceiver, RefusesMissingBricksAndParts) {
    FrameReceiver receiver(true);
    receiver.take(begin(2));
    receiver.take(brick(0));
    EXPECT_THROW(receiver.take(statistics(2)), ServerError);
    receiver.take(brick(1, 0, 2));
    EXPECT_THROW(receiver.take(statistics(4)), ServerError);
    EXPECT_THROW(receiver.end_of_stream(), ServerError);
}

TEST(FrameReceiver, RefusesRepeatedAndSurplusBricks) {
    FrameReceiver receiver(true);
    receiver.take(begin(2));
    receiver.take(brick(0));
    EXPECT_THROW(receiver.take(brick(0)), ServerError);
    receiver.take(brick(1));
    EXPECT_THROW(receiver.take(brick(2)), ServerError);
}

TEST(FrameReceiver, RefusesPartsOutOfOrder) {
    FrameReceiver receiver(true);
    receiver.take(begin(2));
    EXPECT_THROW(receiver.take(brick(0, 1, 2)), ServerError);
    EXPECT_THROW(receiver.take(brick(0, 0, 0)), ServerError);
    receiver.take(brick(0, 0, 3));
    EXPECT_THROW(receiver.take(brick(0, 0, 3)), ServerError);
    EXPECT_THROW(receiver.take(brick(0, 2, 3)), ServerError);
    EXPECT_THROW(receiver.take(brick(0, 1, 4)), ServerError);
    EXPECT_THROW(receiver.take(brick(1, 1, 3)), ServerError);
}

TEST(FrameReceiver, RefusesMessagesOutOfOrder) {
    FrameReceiver receiver(true);
    EXPECT_THROW(receiver.take(brick(0)), ServerError);
    EXPECT_THROW(receiver.take(statistics(0)), ServerError);
    EXPECT_THROW(receiver.take(v1::StreamResponse()), ServerError);
    receiver.take(begin(0));
    EXPECT_THROW(receiver.take(begin(0)), ServerError);
    EXPECT_THROW(receiver.take(statistics(0, 4)), ServerError);
}

TEST(FrameReceiver, RefusesCountsThatContradictEachOther) {
    const auto refuses = [](std::uint64_t announced, std::uint64_t in_statistics) {
        FrameReceiver receiver(true);
        receiver.take(begin(1, announced));
        receiver.take(brick(0));
        EXPECT_THROW(receiver.take(statistics(in_statistics)), ServerError);
    };
    refuses(2, 3);
    refuses(3, 2);
}

/// Has received bricks 0 and 1 of frame 3.
FrameReceiver watching() {
    FrameReceiver receiver(true, true);
    receiver.take(begin(2, 4));
    receiver.take(brick(0));
    receiver.take(brick(1));
    EXPECT_TRUE(receiver.take(statistics(4)));
    return receiver;
}

v1::StreamResponse difference(std::uint32_t bricks, std::uint64_t triangles, std::initializer_list<int> vanished,
                              std::uint64_t base = 3) {
    v1::StreamResponse response = begin(bricks, triangles, 4);
    response.mutable_mesh_begin()->set_base_frame_index(base);
    for (const int x : vanished) response.mutable_mesh_begin()->add_vanished()->set_x(x);
    return response;
}

TEST(FrameReceiver, MergesADifferenceAndSharesWhatStaysTheSame) {
    FrameReceiver receiver = watching();
    receiver.take(difference(2, 6, {}));
    receiver.take(brick(2));
    receiver.take(brick(1));
    // Statistics are of the whole surface, of which a watcher may have asked for a part.
    const auto frame = receiver.take(statistics(99, 4));
    ASSERT_TRUE(frame);
    ASSERT_EQ(frame->bricks.size(), 3U);
    EXPECT_EQ(frame->bricks[0].use_count(), 2);
    for (int x = 0; x < 3; ++x) EXPECT_EQ(frame->bricks[static_cast<std::size_t>(x)]->coordinate[0], x);
    receiver.take(difference(0, 2, {0, 2}, 4));
    EXPECT_EQ(receiver.take(statistics(2, 4))->bricks.size(), 1U);
}

TEST(FrameReceiver, ForgetsAFrameThatIsGivenUpForANewerOne) {
    FrameReceiver receiver = watching();
    receiver.take(difference(2, 2, {0}));
    receiver.take(brick(2, 0, 2));
    receiver.take(difference(0, 2, {1}));
    const auto frame = receiver.take(statistics(2, 4));
    ASSERT_TRUE(frame);
    ASSERT_EQ(frame->bricks.size(), 1U);
    EXPECT_EQ(frame->bricks[0]->coordinate[0], 0);
}

TEST(FrameReceiver, RefusesADifferenceToAFrameItDoesNotHave) {
    EXPECT_THROW(FrameReceiver(true, true).take(difference(0, 0, {})), ServerError);
    EXPECT_THROW(watching().take(difference(0, 4, {}, 2)), ServerError);
    FrameReceiver other_lattice = watching();
    v1::StreamResponse response = difference(0, 4, {});
    response.mutable_mesh_begin()->set_offset_bits(5);
    EXPECT_THROW(other_lattice.take(response), ServerError);
}

TEST(FrameReceiver, RefusesVanishedBricksThatAreNotThere) {
    EXPECT_THROW(watching().take(difference(0, 4, {2})), ServerError);
    EXPECT_THROW(watching().take(difference(0, 2, {1, 1})), ServerError);
    FrameReceiver whole(true, true);
    v1::StreamResponse response = begin(0);
    response.mutable_mesh_begin()->add_vanished();
    EXPECT_THROW(whole.take(response), ServerError);
    FrameReceiver both = watching();
    both.take(difference(1, 4, {1}));
    EXPECT_THROW(both.take(brick(1)), ServerError);
}

TEST(FrameReceiver, RefusesADifferenceThatDoesNotAddUp) {
    FrameReceiver receiver = watching();
    receiver.take(difference(1, 4, {}));
    receiver.take(brick(2));
    EXPECT_THROW(receiver.take(statistics(4, 4)), ServerError);
}

TEST(FrameReceiver, RefusesDifferencesWhereNoneWereAskedFor) {
    FrameReceiver receiver(true);
    receiver.take(begin(0));
    EXPECT_TRUE(receiver.take(statistics(0)));
    EXPECT_THROW(receiver.take(difference(0, 0, {})), ServerError);
}

TEST(FrameReceiver, LetsTheServerSayThatItGoesDown) {
    FrameReceiver receiver(true);
    v1::StreamResponse draining;
    draining.mutable_draining();
    receiver.take(begin(0));
    EXPECT_FALSE(receiver.take(draining));
    EXPECT_TRUE(receiver.take(statistics(0)));
}

TEST(FrameReceiver, RefusesALatticeItCannotRead) {
    const auto refuses = [](const auto& change) {
        v1::StreamResponse response = begin(0);
        change(*response.mutable_mesh_begin());
        FrameReceiver receiver(true);
        EXPECT_THROW(receiver.take(response), ServerError);
    };
    refuses([](v1::MeshBegin& m) { m.set_offset_bits(1); });
    refuses([](v1::MeshBegin& m) { m.set_offset_bits(9); });
    refuses([](v1::MeshBegin& m) { m.set_brick_cells(32); });
    refuses([](v1::MeshBegin& m) { m.set_cell_size(0.0); });
    refuses([](v1::MeshBegin& m) { m.set_cell_size(std::numeric_limits<double>::quiet_NaN()); });
}

TEST(FrameReceiver, RefusesACodecThatItDoesNotKnowWithItsNumber) {
    for (const int number : {0, 7, -1}) {
        FrameReceiver receiver(true);
        receiver.take(begin(1));
        v1::StreamResponse response = brick(0);
        response.mutable_mesh_brick()->set_codec(static_cast<v1::Codec>(number));
        try {
            receiver.take(response);
            FAIL() << number;
        } catch (const ServerError& error) {
            EXPECT_EQ(std::string(error.what()),
                      "frame 3, brick (0, 0, 0) has the codec " + std::to_string(number) +
                          ", which this version does not know; it knows 3 (entropy), 2 (packed), 1 (draco)");
        }
    }
}

TEST(FrameReceiver, RefusesPartsOfOneBrickWithDifferentCodecs) {
    FrameReceiver receiver(true);
    receiver.take(begin(1));
    receiver.take(brick(0, 0, 2));
    v1::StreamResponse response = brick(0, 1, 2);
    response.mutable_mesh_brick()->set_codec(v1::CODEC_UNSPECIFIED);
    EXPECT_THROW(receiver.take(response), ServerError);
}

TEST(FrameReceiver, RefusesMeshesThatWereNotAskedFor) {
    FrameReceiver receiver(false);
    EXPECT_THROW(receiver.take(begin(0)), ServerError);
    EXPECT_TRUE(receiver.take(statistics(7)));
}

TEST(FrameReceiver, ReservesNothingForCountsItIsOnlyTold) {
    FrameReceiver receiver(true);
    receiver.take(begin(std::numeric_limits<std::uint32_t>::max()));
    receiver.take(brick(0, 0, std::numeric_limits<std::uint32_t>::max()));
    EXPECT_THROW(receiver.take(statistics(2)), ServerError);
}

void announce(v1::StreamResponse& response, float coded_maximum, const char* name = "speed") {
    const AttributeRange range{{0.25, 0, 0, 0}, {0.5, 0, 0, 0}};
    CodedAttribute coded;
    coded.name = name;
    coded.bits = 8;
    coded.maximum[0] = coded_maximum;
    v1::MeshBegin& message = *response.mutable_mesh_begin();
    conversion::announce({name, ElementType::float32, 1, {}}, &range, &coded, message);
    conversion::announce({"id", ElementType::uint32, 1, {}}, nullptr, nullptr, message);
}

/// Has received bricks 0 and 1 of frame 3, with speeds over a range from 0 to 1.
FrameReceiver watching_speed() {
    FrameReceiver receiver(true, true);
    v1::StreamResponse response = begin(2, 4);
    announce(response, 1.0F);
    receiver.take(response);
    receiver.take(brick(0));
    receiver.take(brick(1));
    EXPECT_TRUE(receiver.take(statistics(4)));
    return receiver;
}

TEST(FrameReceiver, TellsOfEveryAttributeAndHowTheBricksCarryTheirs) {
    FrameReceiver receiver(true);
    v1::StreamResponse response = begin(0);
    announce(response, 1.0F);
    receiver.take(response);
    const auto frame = receiver.take(statistics(0));
    ASSERT_TRUE(frame);
    ASSERT_EQ(frame->attributes.size(), 2U);
    EXPECT_EQ(frame->attributes[0].name, "speed");
    EXPECT_EQ(frame->attributes[0].range->minimum[0], 0.25);
    EXPECT_EQ(frame->attributes[0].range->maximum[0], 0.5);
    EXPECT_EQ(frame->attributes[1].type, ElementType::uint32);
    EXPECT_FALSE(frame->attributes[1].range);
    ASSERT_EQ(frame->coded_attributes.size(), 1U);
    EXPECT_EQ(frame->coded_attributes[0].maximum[0], 1.0F);
    // A mesh without bricks has them, too.
    const Mesh mesh = frame->mesh();
    ASSERT_EQ(mesh.attributes.size(), 1U);
    EXPECT_EQ(mesh.attributes[0].name, "speed");
}

TEST(FrameReceiver, RefusesAttributesThatAreNone) {
    FrameReceiver receiver(true);
    v1::StreamResponse response = begin(0);
    announce(response, -1.0F);
    EXPECT_THROW(receiver.take(response), ServerError);
}

TEST(FrameReceiver, KeepsABrickOnlyWhileItsAttributesAreCodedAsBefore) {
    const auto refuses = [](float coded_maximum, const char* name, bool both) {
        FrameReceiver receiver = watching_speed();
        v1::StreamResponse response = difference(both ? 2 : 1, 4, {});
        announce(response, coded_maximum, name);
        receiver.take(response);
        receiver.take(brick(1));
        if (both) receiver.take(brick(0));
        try {
            receiver.take(statistics(4, 4));
        } catch (const ServerError&) {
            return true;
        }
        return false;
    };
    EXPECT_FALSE(refuses(1.0F, "speed", false));
    EXPECT_TRUE(refuses(2.0F, "speed", false)) << "another range";
    EXPECT_TRUE(refuses(1.0F, "age", false)) << "another attribute";
    EXPECT_FALSE(refuses(2.0F, "speed", true)) << "no brick stays";
    FrameReceiver none = watching_speed();
    none.take(difference(1, 4, {}));
    none.take(brick(1));
    EXPECT_THROW(none.take(statistics(4, 4)), ServerError);
}

}  // namespace
}  // namespace meniscus::client
