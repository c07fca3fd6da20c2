// Recordings as files: whatever the bytes are, whole frames come out or a clear refusal.
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "conversion/particle_arrays.hpp"
#include "files/recording_checksums.hpp"
#include "files/recording_format.hpp"
#include "formats/recordings/recording.hpp"
#include "meniscus/error.hpp"
#include "meniscus/v1/recording.pb.h"
#include "meniscus/v1/surface_service.pb.h"
#include "recording/recording_entries.hpp"
#include "sample_files.hpp"
#include "sessions/sending/frame_encoder.hpp"
#include "test_frames.hpp"

namespace meniscus::server::test {
namespace {

using formats::RecordedFrame;
using formats::Recording;
using meniscus::test::refusal;
using meniscus::test::TemporaryDirectory;

const std::string session_id = "00000000-0000-4000-8000-000000000001";
constexpr std::int64_t start_time = 1'700'000'000'000'000;
constexpr std::uint64_t everything = std::numeric_limits<std::uint64_t>::max();

InputFrame input(std::uint64_t index, const Particles& particles) {
    InputFrame frame(nullptr);
    frame.index = index;
    frame.simulation_time = 0.5 * static_cast<double>(index);
    frame.particle_count = particles.view().count();
    frame.quantized = particles.view().is_quantized();
    frame.quantization_box = particles.box;
    frame.has_levels = !particles.levels.empty();
    for (const auto bytes : {std::as_bytes(std::span(particles.positions)),
                             std::as_bytes(std::span(particles.quantized)), std::as_bytes(std::span(particles.levels))})
        frame.bytes.insert(frame.bytes.end(), bytes.begin(), bytes.end());
    return frame;
}

std::string bytes_of(const RecordingBytes& bytes) {
    return bytes.entry + bytes.messages;
}

std::string particles_bytes(std::uint64_t index, const Particles& particles) {
    return bytes_of(recorded_particles(input(index, particles), start_time + static_cast<std::int64_t>(index)));
}

std::string mesh_bytes(std::uint64_t index, const Particles& particles) {
    ReconstructedFrame frame;
    frame.index = index;
    frame.received_at = std::chrono::steady_clock::now();
    Reconstructor reconstructor(settings(), {.threads = 1});
    reconstructor.reconstruct(particles.view(), frame.mesh);
    frame.statistics = reconstructor.statistics();
    WorkerPool workers(1);
    ScratchPool scratch;
    return bytes_of(recorded_mesh(
        *encode_frame(frame, {.position_bits = 6, .normal_bits = 8}, nullptr, workers, scratch, nullptr)));
}

std::string beginning() {
    return recording_begin(session_id, settings(), start_time);
}

/// Bytes after their length.
std::string delimited(const std::string& bytes) {
    std::string out;
    std::size_t size = bytes.size();
    for (; size >= 0x80; size >>= 7U) out += static_cast<char>((size & 0x7fU) | 0x80U);
    out += static_cast<char>(size);
    return out + bytes;
}

std::string delimited(const v1::StreamRequest& message) {
    return delimited(message.SerializeAsString());
}

/// With its checksum, as a writer has it.
std::string delimited(const v1::RecordingEntry& entry) {
    return delimited(files::seal(entry));
}

/// The recording as a writer without checksums left it.
std::string without_checksums(const std::string& recording) {
    std::string out(files::recording_magic);
    std::string rest = recording.substr(files::recording_magic.size());
    while (!rest.empty()) {
        std::size_t size = 0;
        std::size_t used = 0;
        do size |= (static_cast<unsigned char>(rest[used]) & 0x7fU) << 7 * used;
        while ((static_cast<unsigned char>(rest[used++]) & 0x80U) != 0);
        v1::RecordingEntry entry;
        EXPECT_TRUE(entry.ParseFromString(rest.substr(used, size)));
        const std::string messages = rest.substr(used + size, entry.bytes());
        rest.erase(0, used + size + messages.size());
        entry.clear_checksum();
        entry.clear_messages_checksum();
        out += delimited(entry.SerializeAsString()) + messages;
    }
    return out;
}

std::string particles_entry(std::uint64_t index, std::uint64_t count, std::uint64_t bytes,
                            std::int64_t arrived_at = start_time) {
    v1::RecordingEntry entry;
    entry.mutable_particles()->set_frame_index(index);
    entry.mutable_particles()->set_particle_count(count);
    entry.set_bytes(bytes);
    entry.mutable_particles()->set_arrived_at(arrived_at);
    return delimited(entry);
}

class RecordingFormat : public testing::Test {
protected:
    Recording open(const std::string& bytes) const {
        const auto path = directory_ / "file.recording";
        std::ofstream(path, std::ios::binary) << bytes;
        return Recording(path);
    }
    /// Why it is refused, when it is opened or read to its end.
    std::string refused(const std::string& bytes) const {
        return refusal([&] { read_all(open(bytes)); });
    }
    static void read_all(const Recording& recording) {
        for (const RecordedFrame& frame : recording.frames()) {
            recording.particles(frame);
            if (frame.mesh) recording.mesh(frame);
        }
    }

    TemporaryDirectory directory_;
};

TEST_F(RecordingFormat, KeepsParticlesAsTheyWereUploaded) {
    Particles leveled = wave(6, 0.0);
    leveled.levels.assign(leveled.positions.size() / 3, 2);
    Particles both = quantized(wave(4, 0.0));
    both.levels.assign(both.quantized.size() / 3, 1);
    const Particles large = wave(48, 0.0);  // 1.3 MB: two chunks
    const std::vector<Particles> all{wave(4, 0.0), quantized(wave(4, 1.0)), leveled, both, large, {}};
    std::string bytes = beginning();
    for (std::size_t i = 0; i < all.size(); ++i) bytes += particles_bytes(i, all[i]);
    const Recording recording = open(bytes);
    EXPECT_EQ(recording.session_id(), session_id);
    EXPECT_EQ(recording.settings(), in_force(settings()));
    EXPECT_EQ(recording.cut_bytes(), 0U);
    ASSERT_EQ(recording.frames().size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const RecordedFrame& frame = recording.frames()[i];
        EXPECT_EQ(frame.index, i);
        EXPECT_EQ(frame.simulation_time, 0.5 * static_cast<double>(i));
        EXPECT_EQ(frame.arrived_at - recording.started_at(), std::chrono::microseconds(i));
        EXPECT_EQ(frame.particle_count, all[i].view().count());
        const auto particles = recording.particles(frame);
        EXPECT_EQ(particles.positions, all[i].positions);
        EXPECT_EQ(particles.quantized, all[i].quantized);
        EXPECT_EQ(particles.quantization_box, all[i].box);
        EXPECT_EQ(particles.levels, all[i].levels);
    }
}

TEST_F(RecordingFormat, GivesAllWholeFramesWhereverTheLastIsCut) {
    std::string bytes = beginning();
    for (const std::uint64_t i : {0, 1}) bytes += particles_bytes(i, wave(1, 0.0)) + mesh_bytes(i, wave(1, 0.0));
    const std::size_t particles_at = bytes.size();
    bytes += particles_bytes(2, wave(1, 1.0));
    const std::size_t mesh_at = bytes.size();
    bytes += mesh_bytes(2, wave(1, 1.0));
    for (std::size_t size = particles_at; size <= bytes.size(); ++size) {
        const Recording recording = open(bytes.substr(0, size));
        ASSERT_EQ(recording.frames().size(), size < mesh_at ? 2U : 3U) << size;
        ASSERT_TRUE(recording.frames()[1].mesh) << size;
        if (size >= mesh_at) {
            ASSERT_EQ(recording.frames()[2].mesh.has_value(), size == bytes.size()) << size;
        }
        const std::size_t whole = size < mesh_at ? particles_at : size < bytes.size() ? mesh_at : bytes.size();
        ASSERT_EQ(recording.cut_bytes(), size - whole);
        ASSERT_NO_THROW(read_all(recording)) << size;
    }
}

TEST_F(RecordingFormat, RefusesABeginningThatIsCut) {
    const std::string bytes = beginning();
    for (std::size_t size = 0; size < bytes.size(); ++size) EXPECT_NE(refused(bytes.substr(0, size)), "") << size;
    EXPECT_EQ(refused(bytes), "");
}

TEST_F(RecordingFormat, SurvivesAnyByteThatIsNotItsOwnThoughNoChecksumShowsIt) {
    const std::string bytes =
        without_checksums(beginning() + particles_bytes(0, wave(1, 0.0)) + mesh_bytes(0, wave(1, 0.0)));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::string damaged = bytes;
        damaged[i] = static_cast<char>(damaged[i] ^ "\x01\x80\xff"[i % 3]);
        try {
            read_all(open(damaged));
        } catch (const InvalidInput&) {
        }
    }
}

TEST_F(RecordingFormat, NoticesEveryByteThatHasChanged) {
    const std::string bytes = beginning() + particles_bytes(0, wave(1, 0.0)) + mesh_bytes(0, wave(1, 0.0));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::string damaged = bytes;
        damaged[i] = static_cast<char>(damaged[i] ^ "\x01\x80\xff"[i % 3]);
        try {
            const Recording recording = open(damaged);
            read_all(recording);
            // A length of an entry that leads past the end of the file.
            EXPECT_GT(recording.cut_bytes(), 0U) << "byte " << i;
        } catch (const InvalidInput&) {
        }
    }
}

TEST_F(RecordingFormat, ReadsWhatWasRecordedBeforeThereWereChecksums) {
    const std::string bytes =
        without_checksums(beginning() + particles_bytes(0, wave(2, 0.0)) + mesh_bytes(0, wave(2, 0.0)));
    const Recording recording = open(bytes);
    EXPECT_FALSE(recording.has_checksums());
    ASSERT_EQ(recording.frames().size(), 1U);
    EXPECT_TRUE(recording.is_whole(recording.frames()[0])) << "as far as can be told";
    EXPECT_EQ(recording.particles(recording.frames()[0]).positions, wave(2, 0.0).positions);
    EXPECT_EQ(mesh_sha256(recording.mesh(recording.frames()[0]).mesh()), local_sha256(wave(2, 0.0)));
}

TEST_F(RecordingFormat, TreatsALengthBeyondTheFileAsItsCutEnd) {
    const std::string whole = beginning() + particles_bytes(0, wave(2, 0.0));
    const std::string tail = particles_entry(1, 1, std::uint64_t{1} << 60U) + "abc";
    const Recording recording = open(whole + tail);
    EXPECT_EQ(recording.frames().size(), 1U);
    EXPECT_EQ(recording.cut_bytes(), tail.size());
}

TEST_F(RecordingFormat, SkipsFieldsAndEntriesThatItDoesNotKnow) {
    constexpr int later_field = 100;
    const std::string messages = "messages of a kind that is not known";
    v1::RecordingEntry later;
    later.GetReflection()->MutableUnknownFields(&later)->AddLengthDelimited(later_field, "checksum");
    later.set_bytes(messages.size());
    v1::RecordingEntry particles;
    const RecordingBytes frame = recorded_particles(input(0, wave(2, 0.0)), start_time);
    particles.mutable_particles()->set_arrived_at(start_time);
    particles.mutable_particles()->set_particle_count(wave(2, 0.0).view().count());
    particles.set_bytes(frame.messages.size());
    particles.GetReflection()->MutableUnknownFields(&particles)->AddVarint(later_field, 7);
    const std::string bytes =
        beginning() + delimited(later) + messages + delimited(particles) + frame.messages + delimited(later) + messages;
    const Recording recording = open(bytes);
    ASSERT_EQ(recording.frames().size(), 1U);
    EXPECT_EQ(recording.cut_bytes(), 0U);
    EXPECT_EQ(recording.particles(recording.frames()[0]).positions, wave(2, 0.0).positions);
    EXPECT_EQ(open(bytes.substr(0, bytes.size() - 1)).cut_bytes(), delimited(later).size() + messages.size() - 1);
}

TEST_F(RecordingFormat, RefusesWhatIsOutOfOrderOrOutOfRange) {
    const std::string first = particles_bytes(5, wave(2, 0.0));
    const std::string mesh = mesh_bytes(5, wave(2, 0.0));
    v1::RecordingEntry unknown;
    v1::RecordingEntry newer;
    newer.mutable_begin()->set_version(3);
    const std::string magic(files::recording_magic);
    const std::string huge_length("\xff\xff\xff\xff\x7f", 5);
    const std::string endless_length(10, '\xff');
    const std::vector<std::pair<std::string, std::string>> cases{
        {"a file of something else", "not a recording"},
        {magic + first, "its first entry is not its beginning"},
        {magic + delimited(newer), "format version 3; this program reads version 2"},
        {recording_begin("../../etc", settings(), start_time), "its session id is '../../etc'"},
        {recording_begin(session_id, {}, start_time), "particle radius is 0"},
        {recording_begin(session_id, settings(), -1), "a time of -1 microseconds"},
        {beginning() + beginning().substr(magic.size()), "a second beginning"},
        {beginning() + first + first, "frame 5 after frame 5; indices must rise"},
        {beginning() + mesh, "the mesh of frame 5, whose particles did not come before"},
        {beginning() + first + mesh + mesh, "a second mesh of frame 5"},
        {beginning() + first + particles_entry(6, 0, 0, start_time - 1), "frame 6 arrived before frame 5"},
        {beginning() + particles_entry(0, 0, 0, std::numeric_limits<std::int64_t>::max()), "a time of"},
        {beginning() + delimited(unknown), "an entry of no kind"},
        {beginning() + huge_length, "at most 4096 are expected there"},
        {beginning() + endless_length, "no message at byte"},
    };
    for (const auto& [bytes, words] : cases) EXPECT_NE(refused(bytes).find(words), std::string::npos) << refused(bytes);
}

TEST_F(RecordingFormat, RefusesMessagesThatAreNotTheirFrame) {
    const auto request = [](const std::function<void(v1::StreamRequest&)>& fill) {
        v1::StreamRequest message;
        fill(message);
        return delimited(message);
    };
    const auto begin = [&](std::uint64_t index, std::uint64_t count, int type = v1::ELEMENT_TYPE_FLOAT32) {
        return request([&](v1::StreamRequest& message) {
            message.mutable_frame_begin()->set_frame_index(index);
            message.mutable_frame_begin()->set_particle_count(count);
            *message.mutable_frame_begin()->mutable_arrays() = conversion::particle_arrays(false, false);
            message.mutable_frame_begin()->mutable_arrays(0)->set_type(static_cast<v1::ElementType>(type));
        });
    };
    const auto chunk = [&](std::size_t size) {
        return request(
            [&](v1::StreamRequest& message) { message.mutable_frame_chunk()->set_data(std::string(size, 'x')); });
    };
    const std::string end = request([](v1::StreamRequest& message) { message.mutable_frame_end(); });
    const std::string huge_length("\xff\xff\xff\xff\x7f", 5);
    constexpr std::uint64_t huge = std::uint64_t{1} << 62U;
    const std::vector<std::tuple<std::uint64_t, std::string, std::string>> cases{
        {1, begin(0, 1) + chunk(12) + end, ""},
        {1, begin(0, 1) + chunk(5) + chunk(7) + end, ""},
        {1, "", "no frame_begin"},
        {1, chunk(12), "no frame_begin"},
        {1, begin(7, 1) + chunk(12) + end, "its frame_begin tells of frame 7 with 1 particles"},
        {2, begin(0, 1) + chunk(12) + end, "its frame_begin tells of frame 0 with 1 particles"},
        {huge, begin(0, huge) + chunk(12) + end, "particles of 12 bytes are announced, but only"},
        {1, begin(0, 1, 9) + chunk(12) + end, "array 'position' has the element type 9"},
        {1, begin(0, 1, v1::ELEMENT_TYPE_UINT16) + chunk(6) + end, "quantization_box"},
        {1, begin(0, 1) + chunk(11) + end, "no frame_chunk"},
        {1, begin(0, 1) + chunk(13) + end, "more bytes than its particles have"},
        {1, begin(0, 1) + chunk(0) + chunk(12) + end, "an empty frame_chunk"},
        {1, begin(0, 1) + chunk(12), "no frame_end"},
        {1, begin(0, 1) + chunk(12) + chunk(1) + end, "no frame_end"},
        {1, begin(0, 1) + chunk(12) + end + end, "messages behind frame_end"},
        {1, begin(0, 1) + huge_length + std::string(40, 'x'), "at most 2097152 are expected there"},
    };
    for (const auto& [count, messages, words] : cases) {
        const std::string why = refused(beginning() + particles_entry(0, count, messages.size()) + messages);
        EXPECT_TRUE(words.empty() ? why.empty() : why.find(words) != std::string::npos) << words << ": " << why;
    }
}

TEST_F(RecordingFormat, RefusesTheMeshOfAnotherFrame) {
    const std::string particles = particles_bytes(0, wave(2, 0.0)) + particles_bytes(1, wave(2, 0.0));
    v1::RecordingEntry entry;
    const RecordingBytes mesh = [] {
        const std::string whole = mesh_bytes(0, wave(2, 0.0));
        const auto entry_size = static_cast<std::size_t>(whole[0]) + 1;
        return RecordingBytes{.entry = whole.substr(0, entry_size), .messages = whole.substr(entry_size)};
    }();
    entry.mutable_mesh()->set_frame_index(1);
    entry.set_bytes(mesh.messages.size());
    EXPECT_NE(refused(beginning() + particles + delimited(entry) + mesh.messages).find("it is that of frame 0"),
              std::string::npos);
}

TEST_F(RecordingFormat, SelectsFramesByTheirIndices) {
    std::string bytes = beginning();
    for (const std::uint64_t i : {2, 5, 6, 9}) bytes += particles_bytes(i, {});
    const Recording recording = open(bytes);
    EXPECT_EQ(recording.frames(3, 6).size(), 2U);
    EXPECT_EQ(recording.frames(0, everything).size(), 4U);
    EXPECT_NE(refusal([&] { recording.frames(7, 8); }).find("no frame from 7 to 8; it holds frames from 2 to 9"),
              std::string::npos);
    EXPECT_NE(refusal([&] { open(beginning()).frames(0, everything); }).find("it holds no frame"), std::string::npos);
}

}  // namespace
}  // namespace meniscus::server::test
