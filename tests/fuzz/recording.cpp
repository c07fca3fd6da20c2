#include "formats/recordings/recording.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <optional>

#include "files/recording_format.hpp"
#include "files/recording_scan.hpp"
#include "formats/recordings/recording_stream.hpp"
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
        formats::RecordingStream stream(file.path());
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

/// Entries in the older form without checksums, so that mutations of them are read instead of refused at once.
std::string without_checksums(const std::string& bytes) {
    const MemoryFile memory(bytes);
    const files::RandomAccessFile file(memory.path());
    files::RecordingScan scan(file);
    std::string out(files::recording_magic);
    const auto append = [&out](v1::RecordingEntry entry, const std::string& messages) {
        entry.clear_checksum();
        entry.clear_messages_checksum();
        const std::string text = entry.SerializeAsString();
        for (std::size_t size = text.size(); size != 0; size >>= 7U)
            out += static_cast<char>((size & 0x7fU) | (size >= 0x80 ? 0x80U : 0U));
        out += text + messages;
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

}  // namespace meniscus::fuzz
