#include "rpc/messages/frame_chunk_reader.hpp"

#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "meniscus/v1/surface_service.pb.h"

namespace meniscus::server {
namespace {

/// The bytes that are read of a message in blocks of this size; none if the message is left to protobuf.
std::optional<std::string> read(const std::string& message, int block_size = -1) {
    google::protobuf::io::ArrayInputStream stream(message.data(), static_cast<int>(message.size()), block_size);
    FrameChunkReader reader(stream, message.size());
    if (!reader.bytes()) return std::nullopt;
    std::string data(*reader.bytes(), '\0');
    reader.copy_to(std::as_writable_bytes(std::span(data)));
    return data;
}

std::string chunk_message(const std::string& data) {
    v1::StreamRequest request;
    request.mutable_frame_chunk()->set_data(data);
    return request.SerializeAsString();
}

std::string bytes(std::initializer_list<int> values) {
    std::string result;
    for (const int value : values) result.push_back(static_cast<char>(value));
    return result;
}

TEST(FrameChunkReader, ReadsChunksOfEverySizeHoweverTheyAreCut) {
    for (const std::size_t size : {1U, 2U, 126U, 127U, 128U, 16383U, 16384U, 1U << 20U}) {
        std::string data(size, 'a');
        for (std::size_t i = 0; i < size; ++i) data[i] = static_cast<char>(i * 7);
        for (const int block : {1, 2, 3, 5, 4096, -1})
            EXPECT_EQ(read(chunk_message(data), block), data) << size << ' ' << block;
    }
}

TEST(FrameChunkReader, LeavesOtherMessagesToProtobuf) {
    v1::StreamRequest begin;
    begin.mutable_frame_begin()->set_frame_index(3);
    v1::StreamRequest end;
    end.mutable_frame_end();
    v1::StreamRequest open;
    open.mutable_open()->set_session_id("x");
    for (const v1::StreamRequest& request : {begin, end, open, v1::StreamRequest{}})
        EXPECT_FALSE(read(request.SerializeAsString()));
    EXPECT_FALSE(read(chunk_message("")));  // its data is not on the wire
}

TEST(FrameChunkReader, LeavesWhatIsNotJustOneChunkToProtobuf) {
    const std::string chunk = chunk_message("data");
    const std::string twice_data = bytes({0x1a, 6, 0x0a, 1, 'a', 0x0a, 1, 'b'});
    const std::string unknown_inside = bytes({0x1a, 5, 0x0a, 1, 'a', 0x10, 1});
    const std::string unknown_before = bytes({0x78, 1}) + chunk;
    const std::string unknown_after = chunk + bytes({0x78, 1});
    for (const std::string& message : {chunk + chunk, twice_data, unknown_inside, unknown_before, unknown_after}) {
        v1::StreamRequest request;
        EXPECT_TRUE(request.ParseFromString(message));  // all of them are right
        EXPECT_FALSE(read(message)) << ::testing::PrintToString(message);
    }
}

TEST(FrameChunkReader, LeavesLongVarintsToProtobuf) {
    EXPECT_FALSE(read(bytes({0x1a, 0x83, 0x00, 0x0a, 1, 'a'})));
    EXPECT_FALSE(read(bytes({0x9a, 0x00, 3, 0x0a, 1, 'a'})));
    EXPECT_FALSE(read(bytes({0x1a, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x01})));
    EXPECT_FALSE(read(bytes({0x1a, 0x83, 0x80, 0x80, 0x80, 0x10, 0x0a, 1, 'a'})));
}

TEST(FrameChunkReader, ReadsNoTruncatedMessageAndNoLie) {
    const std::string whole = chunk_message(std::string(300, 'z'));
    for (std::size_t size = 0; size < whole.size(); ++size)
        for (const int block : {1, -1}) EXPECT_FALSE(read(whole.substr(0, size), block)) << size;
    for (const int length : {0, 2, 4, 0x7f}) EXPECT_FALSE(read(bytes({0x1a, length, 0x0a, 1, 'a'}))) << length;
    for (const int length : {0, 2, 3, 0x7f}) EXPECT_FALSE(read(bytes({0x1a, 3, 0x0a, length, 'a'}))) << length;
}

/// Whatever it reads, protobuf reads too.
TEST(FrameChunkReader, AgreesWithProtobufAboutEveryShortMessageOfItsAlphabet) {
    const std::string alphabet = bytes({0x00, 0x01, 0x02, 0x03, 0x04, 0x0a, 0x1a, 0x80, 'x'});
    std::size_t read_ones = 0;
    for (std::size_t size = 1; size <= 6; ++size) {
        std::vector<std::size_t> digits(size, 0);
        for (std::size_t at = 0; at < size;) {
            std::string message;
            for (const std::size_t digit : digits) message.push_back(alphabet[digit]);
            if (const auto data = read(message)) {
                ++read_ones;
                v1::StreamRequest request;
                ASSERT_TRUE(request.ParseFromString(message)) << ::testing::PrintToString(message);
                ASSERT_EQ(request.frame_chunk().data(), *data);
            }
            for (at = 0; at < size && ++digits[at] == alphabet.size(); ++at) digits[at] = 0;
        }
    }
    EXPECT_GT(read_ones, 80U);
}

}  // namespace
}  // namespace meniscus::server
