// Recordings through a pipe: the particles of the file, or a refusal that says what is wrong, and where.
#include <fcntl.h>
#include <google/protobuf/unknown_field_set.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <future>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "conversion/particle_arrays.hpp"
#include "files/recording_checksums.hpp"
#include "files/recording_format.hpp"
#include "formats/recordings/recording_stream.hpp"
#include "meniscus/error.hpp"
#include "meniscus/v1/recording.pb.h"
#include "meniscus/v1/surface_service.pb.h"
#include "recording/recording_entries.hpp"
#include "sample_files.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {
namespace {

using formats::RecordedParticles;
using formats::RecordingStream;

class RecordingStreamed : public testing::Test {
protected:
    RecordingStreamed() {
        std::signal(SIGPIPE, SIG_IGN);  // of a writer whose reader has refused its bytes
        EXPECT_EQ(::mkfifo(pipe_.c_str(), 0600), 0);
    }

    struct Read {
        std::vector<std::pair<RecordingStream::Frame, RecordedParticles>> frames;
        std::string refusal;  ///< empty: it has ended well
    };
    /// Writes the bytes, in pieces of this size, while they are read.
    Read read(const std::string& bytes, std::size_t piece = 1000, const formats::ReadLimits& limits = {}) {
        std::thread writer([&] {
            const int out = ::open(pipe_.c_str(), O_WRONLY | O_CLOEXEC);
            for (std::size_t at = 0; at < bytes.size(); at += piece)
                if (::write(out, bytes.data() + at, std::min(piece, bytes.size() - at)) < 0) break;
            ::close(out);
        });
        Read result;
        try {
            formats::InputPipe pipe(pipe_);
            formats::PipedMessages messages(pipe);
            RecordingStream stream(messages, limits);
            RecordedParticles particles;
            while (const auto frame = stream.next(particles)) result.frames.emplace_back(*frame, particles);
        } catch (const InvalidInput& error) {
            result.refusal = error.what();
        }
        writer.join();
        return result;
    }

    static std::string delimited(const std::string& bytes) {
        std::string out;
        std::size_t size = bytes.size();
        for (; size >= 0x80; size >>= 7U) out += static_cast<char>((size & 0x7fU) | 0x80U);
        out += static_cast<char>(size);
        return out + bytes;
    }
    static std::string beginning() { return recording_begin("00000000-0000-4000-8000-000000000001", settings(), 0); }
    static std::string recorded(std::uint64_t index, const Particles& particles) {
        InputFrame frame(nullptr);
        frame.index = index;
        frame.simulation_time = 0.5 * static_cast<double>(index);
        frame.particle_count = particles.view().count();
        frame.quantized = particles.view().is_quantized();
        frame.quantization_box = particles.box;
        frame.has_levels = !particles.levels.empty();
        for (const auto bytes :
             {std::as_bytes(std::span(particles.positions)), std::as_bytes(std::span(particles.quantized)),
              std::as_bytes(std::span(particles.levels))})
            frame.bytes.insert(frame.bytes.end(), bytes.begin(), bytes.end());
        const RecordingBytes bytes = recorded_particles(frame, static_cast<std::int64_t>(index));
        return bytes.entry + bytes.messages;
    }
    static std::string entry(std::uint64_t index, std::uint64_t particles, std::uint64_t bytes) {
        v1::RecordingEntry entry;
        entry.mutable_particles()->set_frame_index(index);
        entry.mutable_particles()->set_particle_count(particles);
        entry.set_bytes(bytes);
        return delimited(files::seal(entry));
    }

    meniscus::test::TemporaryDirectory directory_;
    std::string pipe_ = (directory_ / "pipe").string();
};

Particles with_levels(Particles particles) {
    particles.levels.assign(particles.positions.size() / 3, 1);
    return particles;
}

TEST_F(RecordingStreamed, GivesTheParticlesThatWereWrittenHoweverTheyAreCut) {
    const std::vector<Particles> frames{wave(5, 0.0), quantized(wave(3, 1.0)), with_levels(wave(4, 2.0)), {}};
    std::string bytes = beginning();
    for (std::size_t i = 0; i < frames.size(); ++i) bytes += recorded(3 * i, frames[i]);
    for (const std::size_t piece : {1U, 7U, 4096U}) {
        const Read result = read(bytes, piece);
        EXPECT_EQ(result.refusal, "");
        ASSERT_EQ(result.frames.size(), frames.size());
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const auto& [frame, particles] = result.frames[i];
            EXPECT_EQ(frame.index, 3 * i);
            EXPECT_EQ(frame.simulation_time, 1.5 * static_cast<double>(i));
            EXPECT_EQ(particles.positions, frames[i].positions);
            EXPECT_EQ(particles.quantized, frames[i].quantized);
            EXPECT_EQ(particles.levels, frames[i].levels);
        }
    }
}

TEST_F(RecordingStreamed, PassesOverMeshesAndEntriesOfLaterVersions) {
    const std::string messages(100000, 'x');
    v1::RecordingEntry mesh;
    mesh.mutable_mesh()->set_frame_index(0);
    mesh.set_bytes(messages.size());
    v1::RecordingEntry later;
    later.GetReflection()->MutableUnknownFields(&later)->AddVarint(100, 7);
    later.set_bytes(messages.size());
    const std::string others = delimited(files::seal(mesh)) + messages + delimited(files::seal(later)) + messages;
    const Read result = read(beginning() + recorded(0, wave(2, 0.0)) + others + recorded(1, wave(2, 1.0)) + others);
    EXPECT_EQ(result.refusal, "");
    EXPECT_EQ(result.frames.size(), 2U);
}

TEST_F(RecordingStreamed, GivesTheFramesBeforeACutAndSaysWhereThatIs) {
    const std::string before = beginning() + recorded(4, wave(2, 0.0));
    const std::string last = recorded(5, wave(2, 1.0));
    for (std::size_t size = 1; size < last.size(); ++size) {
        const Read result = read(before + last.substr(0, size));
        EXPECT_EQ(result.frames.size(), 1U);
        EXPECT_NE(result.refusal.find("it ends at byte " + std::to_string(before.size() + size) + ", within "),
                  std::string::npos)
            << result.refusal;
    }
    EXPECT_NE(read((before + last).substr(0, before.size() + last.size() - 1)).refusal.find("within frame 5"),
              std::string::npos);
    EXPECT_EQ(read(before).refusal, "");
}

TEST_F(RecordingStreamed, RefusesWhatIsNoRecordingWithFrameAndByte) {
    const std::string first = recorded(5, wave(2, 0.0));
    const std::string magic(files::recording_magic);
    const std::string place = "at byte " + std::to_string((beginning() + first).size()) + ", behind frame 5: ";
    std::string damaged = recorded(6, wave(2, 0.0));
    damaged[damaged.size() - 10] ^= 1;
    const std::vector<std::pair<std::string, std::string>> cases{
        {"", "neither a recording nor bricks"},
        {"Meniscus brocks\n", "(byte 9 is another"},
        {beginning() + first + "Meniscus bricks\n", place + "bricks behind a recording"},
        {magic, "before its first entry"},
        {magic + first, "its first entry is not its beginning"},
        {beginning() + first + beginning().substr(magic.size()), place + "a second beginning"},
        {beginning() + first + first, place + "frame 5 after frame 5; indices must rise"},
        {beginning() + first + entry(6, 1U << 30U, 1U << 20U) + std::string(10, '\0'), "frame 6, at byte"},
        {beginning() + first + entry(6, 1, std::uint64_t{1} << 60U),
         place + "frame 6 is announced with 1152921504606846976 bytes; at most "},
        {beginning() + first + damaged, "frame 6 does not have its checksum"},
        {beginning() + std::string("\xff\xff\xff\xff\x7f", 5), "at most 4096 are expected there"},
        {beginning() + std::string(10, '\xff'), "no message at byte"},
    };
    for (const auto& [bytes, words] : cases) {
        const std::string refusal = read(bytes).refusal;
        EXPECT_NE(refusal.find(words), std::string::npos) << refusal << "\nexpected: " << words;
        EXPECT_EQ(refusal.rfind(pipe_ + ": ", 0), 0U) << refusal;
    }
}

TEST_F(RecordingStreamed, TakesNoMemoryForWhatIsAnnouncedAlone) {
    v1::StreamRequest begin;
    begin.mutable_frame_begin()->set_frame_index(0);
    begin.mutable_frame_begin()->set_particle_count(std::uint64_t{1} << 40U);
    *begin.mutable_frame_begin()->mutable_arrays() = conversion::particle_arrays(false, false);
    const formats::ReadLimits all{.most_bytes = std::uint64_t{1} << 62U};
    const std::string bytes =
        beginning() + entry(0, std::uint64_t{1} << 40U, std::uint64_t{1} << 60U) + delimited(begin.SerializeAsString());
    EXPECT_NE(read(bytes, 1000, all).refusal.find("within frame 0"), std::string::npos);
}

TEST_F(RecordingStreamed, EndsWhenItIsStoppedThoughItsPipeGoesOn) {
    const std::string bytes = beginning() + recorded(0, wave(2, 0.0));
    const int both = ::open(pipe_.c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_EQ(::write(both, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    formats::InputPipe pipe(pipe_);
    formats::PipedMessages messages(pipe);
    RecordingStream stream(messages);
    RecordedParticles particles;
    ASSERT_TRUE(stream.next(particles));
    auto next = std::async(std::launch::async, [&] { return stream.next(particles).has_value(); });
    pipe.stop();
    EXPECT_FALSE(next.get());
    EXPECT_FALSE(stream.next(particles));
    ::close(both);
}

}  // namespace
}  // namespace meniscus::server::test
