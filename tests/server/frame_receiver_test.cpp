// A server that lies is found out.
#include "frame_receiver.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::client {
namespace {

v1::StreamResponse begin(std::uint32_t bricks) {
    v1::StreamResponse response;
    v1::MeshBegin& message = *response.mutable_mesh_begin();
    message.set_frame_index(3);
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
    message.set_draco(std::string(1, static_cast<char>('a' + part)));
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
    EXPECT_FALSE(receiver.take(begin(2)));
    for (std::uint32_t part = 0; part < 3; ++part) EXPECT_FALSE(receiver.take(brick(0, part, 3)));
    EXPECT_FALSE(receiver.take(brick(1)));
    const auto frame = receiver.take(statistics(4));
    ASSERT_TRUE(frame);
    ASSERT_EQ(frame->bricks.size(), 2U);
    EXPECT_EQ(frame->bricks[0].draco, (std::vector<std::byte>{std::byte{'a'}, std::byte{'b'}, std::byte{'c'}}));
    receiver.end_of_stream();
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
    FrameReceiver receiver(true);
    receiver.take(begin(1));
    receiver.take(brick(0));
    EXPECT_THROW(receiver.take(statistics(3)), ServerError);
}

TEST(FrameReceiver, RefusesALatticeItCannotRead) {
    const auto refuses = [](const auto& change) {
        v1::StreamResponse response = begin(0);
        change(*response.mutable_mesh_begin());
        FrameReceiver receiver(true);
        EXPECT_THROW(receiver.take(response), ServerError);
    };
    refuses([](v1::MeshBegin& m) { m.set_offset_bits(1); });
    refuses([](v1::MeshBegin& m) { m.set_offset_bits(10); });
    refuses([](v1::MeshBegin& m) { m.set_brick_cells(32); });
    refuses([](v1::MeshBegin& m) { m.set_cell_size(0.0); });
    refuses([](v1::MeshBegin& m) { m.set_cell_size(std::numeric_limits<double>::quiet_NaN()); });
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

}  // namespace
}  // namespace meniscus::client
