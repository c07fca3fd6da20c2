// Finished bricks through a pipe: the frames that were written, or a refusal that says what is wrong, and where.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <future>
#include <limits>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "conversion/statistics_conversion.hpp"
#include "files/brick_file_format.hpp"
#include "formats/bytes/atomic_file.hpp"
#include "formats/recordings/brick_file.hpp"
#include "formats/recordings/brick_stream.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh_hash.hpp"
#include "meniscus/v1/brick_file.pb.h"
#include "meniscus/v1/surface_service.pb.h"
#include "own_surfaces.hpp"
#include "push_fixture.hpp"
#include "pushing/statistics_message.hpp"

namespace meniscus::test {
namespace {

Settings block_settings() {
    Settings settings;
    settings.particle_radius = 0.1;
    settings.all_attributes = true;
    settings.spray = Spray::points;
    return settings;
}

client::ReceivedFrame frame_of(std::uint64_t index, unsigned side = 2) {
    const Block block(side, static_cast<float>(index));
    return surface_of(block_settings(), block.frame(), index);
}

std::string delimited(const google::protobuf::MessageLite& message) {
    const std::string bytes = message.SerializeAsString();
    std::string out;
    std::size_t size = bytes.size();
    for (; size >= 0x80; size >>= 7U) out += static_cast<char>((size & 0x7fU) | 0x80U);
    out += static_cast<char>(size);
    return out + bytes;
}

class BricksStreamed : public testing::Test {
protected:
    BricksStreamed() {
        std::signal(SIGPIPE, SIG_IGN);  // of a writer whose reader has refused its bytes
        EXPECT_EQ(::mkfifo(pipe_.c_str(), 0600), 0);
    }

    struct Read {
        std::vector<client::ReceivedFrame> frames;
        std::string refusal;  ///< empty: it has ended well
    };
    static Read read_from(const std::string& path, const formats::ReadLimits& limits = {}) {
        Read result;
        try {
            formats::InputPipe pipe(path);
            formats::PipedMessages messages(pipe);
            formats::BrickStream stream(messages, limits);
            while (auto frame = stream.next()) result.frames.push_back(*std::move(frame));
        } catch (const InvalidInput& error) {
            result.refusal = error.what();
        }
        return result;
    }
    Read read(const std::string& bytes, const formats::ReadLimits& limits = {}) {
        formats::write_file(file_, bytes);
        return read_from(file_, limits);
    }
    /// Writes the bytes, in pieces of this size, while they are read.
    Read read_piecewise(const std::string& bytes, std::size_t piece) {
        std::thread writer([&] {
            const int out = ::open(pipe_.c_str(), O_WRONLY | O_CLOEXEC);
            for (std::size_t at = 0; at < bytes.size(); at += piece)
                if (::write(out, bytes.data() + at, std::min(piece, bytes.size() - at)) < 0) break;
            ::close(out);
        });
        Read result = read_from(pipe_);
        writer.join();
        return result;
    }

    TemporaryDirectory directory_;
    std::string pipe_ = (directory_ / "pipe").string();
    std::string file_ = (directory_ / "file").string();
};

TEST_F(BricksStreamed, AreTheFramesThatWereWrittenHoweverTheyAreCut) {
    std::vector<client::ReceivedFrame> frames{frame_of(0), frame_of(3, 4), frame_of(4), frame_of(9)};
    frames[1].spray = {{1.0F, -2.0F, 0.5F}, {0.0F, 3.0F, 1e-9F}};
    frames[3].bricks.clear();
    frames[3].statistics.triangles = 0;
    // Two in the first file, one each in the others.
    const std::string bytes = pushing::bricks_beginning() + bytes_of(frames[0]) + bytes_of(frames[1]) +
                              pushing::bricks_beginning() + bytes_of(frames[2]) + pushing::bricks_beginning() +
                              pushing::bricks_beginning() + bytes_of(frames[3]);
    for (const std::size_t piece : {1U, 7U, 4096U}) {
        const Read result = read_piecewise(bytes, piece);
        EXPECT_EQ(result.refusal, "");
        ASSERT_EQ(result.frames.size(), frames.size());
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const client::ReceivedFrame& is = result.frames[i];
            EXPECT_EQ(is.index, frames[i].index);
            EXPECT_EQ(is.simulation_time, frames[i].simulation_time);
            EXPECT_EQ(is.spray, frames[i].spray);
            EXPECT_EQ(is.coded_attributes, frames[i].coded_attributes);
            EXPECT_EQ(is.statistics.volume, frames[i].statistics.volume);
            ASSERT_EQ(is.bricks.size(), frames[i].bricks.size());
            const Mesh mesh = is.mesh();
            const Mesh expected = frames[i].mesh();
            EXPECT_EQ(mesh_sha256(mesh), mesh_sha256(expected));
            ASSERT_EQ(mesh.attributes.size(), 2U);
            for (std::size_t a = 0; a < 2; ++a) EXPECT_EQ(mesh.attributes[a].data, expected.attributes[a].data);
        }
    }
}

TEST_F(BricksStreamed, OfFilesThatBeginAgainGoOnWithTheNextIndices) {
    const std::string file = pushing::bricks_beginning() + bytes_of(frame_of(0)) + bytes_of(frame_of(4));
    const Read result = read(file + file + pushing::bricks_beginning() + bytes_of(frame_of(20)) + file);
    EXPECT_EQ(result.refusal, "");
    std::vector<std::uint64_t> indices;
    for (const client::ReceivedFrame& frame : result.frames) indices.push_back(frame.index);
    EXPECT_EQ(indices, (std::vector<std::uint64_t>{0, 4, 5, 9, 20, 21, 25}));
    constexpr std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
    client::ReceivedFrame at_last = frame_of(3);
    at_last.index = last;
    EXPECT_NE(read(pushing::bricks_beginning() + bytes_of(at_last) + file).refusal.find("indices must rise"),
              std::string::npos);
}

TEST_F(BricksStreamed, AreThoseThatFilesHave) {
    const client::ReceivedFrame frame = frame_of(5, 4);
    formats::write_bricks(file_, frame);
    const Read result = read_from(file_);
    EXPECT_EQ(result.refusal, "");
    ASSERT_EQ(result.frames.size(), 1U);
    EXPECT_EQ(mesh_sha256(result.frames[0].mesh()), mesh_sha256(frame.mesh()));
    const client::ReceivedFrame by_hand = formats::read_bricks("bricks", pushing::bricks_beginning() + bytes_of(frame));
    EXPECT_EQ(mesh_sha256(by_hand.mesh()), mesh_sha256(frame.mesh()));
    ASSERT_EQ(by_hand.attributes.size(), 2U);
    for (std::size_t a = 0; a < 2; ++a) EXPECT_EQ(by_hand.attributes[a].range, frame.attributes[a].range);
}

TEST_F(BricksStreamed, HaveTheFieldsOfEachFigure) {
    Statistics statistics;
    std::uint64_t next = 7;
    Statistics::rows([&](std::string_view, auto member, const Facts&) {
        auto& value = statistics.*member;
        using Value = std::remove_reference_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, std::string>)
            value = "cuda";
        else if constexpr (std::is_arithmetic_v<Value>)
            value = static_cast<Value>(next++);
        else if constexpr (!std::is_same_v<Value, std::vector<Warning>>)
            for (auto& entry : value) entry = static_cast<std::remove_reference_t<decltype(entry)>>(next++);
    });
    for (const WarningCode code : choices<WarningCode>)
        statistics.warnings.push_back({code, 0.5, 0.25, "it is \xc3\xb6 " + std::string(name_of(code))});
    v1::FrameStatistics expected;
    conversion::to_wire(statistics, expected);
    v1::FrameStatistics is;
    ASSERT_TRUE(is.ParseFromString(pushing::statistics_message(statistics).bytes()));
    EXPECT_EQ(is.DebugString(), expected.DebugString());
}

TEST_F(BricksStreamed, GiveTheFramesBeforeACutAndSayWhereThatIs) {
    const std::string before = pushing::bricks_beginning() + bytes_of(frame_of(4));
    const std::string last = bytes_of(frame_of(5));
    for (std::size_t size = 1; size < last.size(); size += size < 64 || last.size() - size < 64 ? 1 : 37) {
        const Read result = read(before + last.substr(0, size));
        EXPECT_EQ(result.frames.size(), 1U);
        EXPECT_NE(result.refusal.find("it ends at byte " + std::to_string(before.size() + size) + ", within "),
                  std::string::npos)
            << size << ": " << result.refusal;
    }
    EXPECT_NE(read((before + last).substr(0, before.size() + last.size() - 1)).refusal.find("within frame 5"),
              std::string::npos);
    EXPECT_EQ(read(before).refusal, "");
    for (std::size_t size = 1; size < pushing::bricks_beginning().size(); ++size)
        EXPECT_NE(read(before + pushing::bricks_beginning().substr(0, size)).refusal, "") << size;
}

TEST_F(BricksStreamed, AreRefusedWithFrameAndByte) {
    const std::string first = pushing::bricks_beginning() + bytes_of(frame_of(5));
    const std::string place = "at byte " + std::to_string(first.size()) + ": ";
    v1::BrickFileBegin of_version_3;
    of_version_3.set_version(3);
    v1::StreamResponse brick;
    brick.mutable_mesh_brick()->set_part_count(1);
    v1::StreamResponse begin;
    begin.mutable_mesh_begin()->set_frame_index(6);
    begin.mutable_mesh_begin()->set_cell_size(0.05);
    begin.mutable_mesh_begin()->set_offset_bits(6);
    begin.mutable_mesh_begin()->set_brick_cells(64);
    v1::StreamResponse difference = begin;
    difference.mutable_mesh_begin()->set_base_frame_index(5);
    v1::StreamResponse timeless = begin;
    timeless.mutable_mesh_begin()->set_simulation_time(std::numeric_limits<double>::quiet_NaN());
    v1::StreamResponse statistics;
    statistics.mutable_frame_statistics()->set_frame_index(6);
    v1::StreamResponse of_other_triangles = statistics;
    of_other_triangles.mutable_frame_statistics()->set_triangles(1);
    const std::vector<std::pair<std::string, std::string>> cases{
        {"", "not a file of bricks"},
        {"Meniscus bracks\n", "not a file of bricks"},
        {std::string(files::brick_file_magic), "it ends at byte 16, within an entry"},
        {std::string(files::brick_file_magic) + delimited(of_version_3), "version 3; this program reads version 2"},
        {std::string(files::brick_file_magic) + std::string("\x02\xff\xff", 3), "no beginning of a file of bricks"},
        {first + pushing::recording_beginning(), place + "a recording behind bricks"},
        {first + bytes_of(frame_of(5)), place + "frame 5 after frame 5; indices must rise"},
        {first + delimited(brick), place + "the server sent a brick outside of a frame"},
        {first + delimited(statistics), place + "the server sent statistics of frame 6 without its mesh"},
        {first + delimited(begin) + delimited(begin), "frame 6 begins before frame 6 has ended"},
        {first + delimited(begin) + pushing::bricks_beginning() + bytes_of(frame_of(7)),
         "no message of a frame of bricks"},
        {first + delimited(begin) + delimited(of_other_triangles), "its statistics say 1"},
        {first + delimited(begin) + delimited(brick), "is one more than the 0 that were announced"},
        {first + delimited(difference), "is a difference to frame 5, which was not asked for"},
        {first + delimited(timeless), "frame 6 has simulation time nan; it must be finite"},
        {first + std::string("\x05hello"), place + "no message of a frame of bricks"},
        {first + std::string("\xff\xff\xff\xff\x7f", 5), "at most 2097152 are expected there"},
        {first + std::string(10, '\xff'), "no message at byte"},
    };
    for (const auto& [bytes, words] : cases) {
        const std::string refusal = read(bytes).refusal;
        EXPECT_NE(refusal.find(words), std::string::npos) << refusal << "\nexpected: " << words;
        EXPECT_EQ(refusal.rfind(file_ + ": ", 0), 0U) << refusal;
    }
}

TEST_F(BricksStreamed, TakeNoMoreMemoryThanIsAllowed) {
    const std::string bytes = pushing::bricks_beginning() + bytes_of(frame_of(5, 4));
    EXPECT_NE(
        read(bytes, {.most_bytes = 1000}).refusal.find("frame 5 has more than 1000 bytes, the most that are read"),
        std::string::npos);
    EXPECT_EQ(read(bytes, {.most_bytes = bytes.size()}).refusal, "");
}

TEST_F(BricksStreamed, EndWhenTheyAreStoppedThoughTheirPipeGoesOn) {
    const std::string bytes = pushing::bricks_beginning() + bytes_of(frame_of(0));
    const int both = ::open(pipe_.c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_EQ(::write(both, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    formats::InputPipe pipe(pipe_);
    formats::PipedMessages messages(pipe);
    formats::BrickStream stream(messages);
    ASSERT_TRUE(stream.next());
    auto next = std::async(std::launch::async, [&] { return stream.next().has_value(); });
    pipe.stop();
    EXPECT_FALSE(next.get());
    EXPECT_FALSE(stream.next());
    ::close(both);
}

}  // namespace
}  // namespace meniscus::test
