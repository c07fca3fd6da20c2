#include "formats/recordings/recording.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <optional>
#include <string>
#include <vector>

#include "files/brick_file_format.hpp"
#include "files/recording_format.hpp"
#include "files/recording_scan.hpp"
#include "formats/recordings/brick_stream.hpp"
#include "formats/recordings/recording_stream.hpp"
#include "meniscus/v1/brick_file.pb.h"
#include "receiving/frame_messages.hpp"
#include "recording/recording_entries.hpp"
#include "support.hpp"

namespace meniscus::fuzz {

namespace {

/// A file in memory.
class MemoryFile {
public:
    explicit MemoryFile(Bytes bytes) : descriptor_(::memfd_create("recording", MFD_CLOEXEC)) {
        require(::write(descriptor_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
                "the input is a file");
    }
    ~MemoryFile() { ::close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

private:
    int descriptor_;
};

void append_delimited(const google::protobuf::MessageLite& message, std::string& out) {
    const std::string text = message.SerializeAsString();
    for (std::size_t size = text.size(); size != 0; size >>= 7U)
        out += static_cast<char>((size & 0x7fU) | (size >= 0x80 ? 0x80U : 0U));
    out += text;
}

server::InputFrame frame(std::uint64_t index, bool quantized, bool levels) {
    constexpr std::size_t particles = 2;
    server::InputFrame frame(nullptr);
    frame.index = index;
    frame.particle_count = particles;
    frame.quantized = quantized;
    frame.has_levels = levels;
    frame.bytes.assign(particles * ((quantized ? 6U : 12U) + (levels ? 1U : 0U)), std::byte{0});
    return frame;
}

}  // namespace

void recording(Bytes bytes) {
    const MemoryFile file(bytes);
    may_refuse([&] {
        const formats::Recording recording(file.path());
        require(recording.cut_bytes() < bytes.size(), "a recording has a beginning");
        for (const formats::RecordedFrame& recorded : recording.frames()) {
            may_refuse([&] {
                const auto particles = recording.particles(recorded);
                require(particles.view().count() == recorded.particle_count, "all of a frame's particles");
            });
            if (recorded.mesh) may_refuse([&] { (void)recording.mesh(recorded); });
        }
    });
}

void piped_recording(Bytes bytes) {
    const MemoryFile file(bytes);
    may_refuse([&] {
        formats::InputPipe pipe(file.path());
        formats::PipedMessages messages(pipe);
        formats::RecordingStream stream(messages);
        formats::RecordedParticles particles;
        std::optional<std::uint64_t> last;
        while (const auto frame = stream.next(particles)) {
            require(!last || frame->index > *last, "indices rise");
            last = frame->index;
            const std::size_t count = particles.view().count();
            require(particles.levels.empty() || particles.levels.size() == count, "a level of each particle");
            for (const formats::NamedValues& array : particles.arrays)
                require(array.count() == count, "a value of each particle");
            require(count <= bytes.size(), "particles have bytes");
        }
    });
}

void piped_bricks(Bytes bytes) {
    const MemoryFile file(bytes);
    may_refuse([&] {
        formats::InputPipe pipe(file.path());
        formats::PipedMessages messages(pipe);
        formats::BrickStream stream(messages);
        std::optional<std::uint64_t> last;
        while (const auto frame = stream.next()) {
            require(!last || frame->index > *last, "indices rise");
            last = frame->index;
            std::size_t brick_bytes = 0;
            for (const auto& brick : frame->bricks) brick_bytes += brick->data.size();
            require(brick_bytes <= bytes.size(), "bricks have bytes");
            may_refuse([&] { (void)frame->mesh(); });
        }
    });
}

/// Entries in the older form without checksums, so that mutations of them are read instead of refused at once.
std::string without_checksums(const std::string& bytes) {
    const MemoryFile memory(bytes);
    const files::RandomAccessFile file(memory.path());
    files::RecordingScan scan(file);
    std::string out(files::recording_magic);
    const auto append = [&out](v1::RecordingEntry entry, const std::string& messages) {
        entry.clear_checksum();
        entry.clear_messages_checksum();
        append_delimited(entry, out);
        out += messages;
    };
    v1::RecordingEntry begin;
    *begin.mutable_begin() = scan.begin();
    append(begin, {});
    while (const auto item = scan.next())
        append(item->entry, file.read(item->messages.first, static_cast<std::size_t>(item->messages.size)));
    return out;
}

Seeds recording_seeds() {
    Settings settings;
    settings.particle_radius = 0.1;
    const std::string begin = server::recording_begin("00000000-0000-4000-8000-000000000001", settings, 0);
    std::string all = begin;
    for (const std::uint64_t i : {0, 1, 2, 3}) {
        const server::RecordingBytes particles = server::recorded_particles(frame(i, i % 2 == 1, i > 1), 0);
        all += particles.entry + particles.messages;
    }
    return {begin, all, without_checksums(begin), without_checksums(all)};
}

Seeds piped_bricks_seeds() {
    Seeds seeds;
    for (const bool attributes : {false, true})
        for (const Codec codec : codecs) {
            const Mesh mesh = sample_mesh(attributes);
            CodingOptions options{.codec = codec};
            const std::vector<AttributeWish> all{{.name = {}, .bits = attributes ? 0 : 8}};
            options.attributes = coded_attributes(mesh, attribute_ranges(mesh), all);
            Statistics statistics;
            statistics.triangles = mesh.triangles.size();
            std::string beginning(files::brick_file_magic);
            v1::BrickFileBegin begin;
            begin.set_version(files::brick_file_version);
            append_delimited(begin, beginning);
            std::string file = beginning;
            for (const std::uint64_t i : {0, 1})
                client::give_messages(client::encode_frame(mesh, statistics, i, 0.5, options), nullptr,
                                      [&file](const auto& message) { append_delimited(message, file); });
            seeds.push_back(file);
            std::string next = beginning;
            client::give_messages(client::encode_frame(mesh, statistics, 7, 1.0, options), nullptr,
                                  [&next](const auto& message) { append_delimited(message, next); });
            seeds.push_back(file + next);
        }
    return seeds;
}

}  // namespace meniscus::fuzz
