#include "formats/recording.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "conversion/recording_format.hpp"
#include "conversion/settings_conversion.hpp"
#include "formats/brick_file.hpp"
#include "formats/byte_cursor.hpp"
#include "formats/delimited_messages.hpp"
#include "formats/recorded_particles.hpp"
#include "meniscus/error.hpp"
#include "meniscus/v1/recording.pb.h"

namespace meniscus::formats {
namespace {

using Time = std::chrono::system_clock::time_point;

bool is_session_id(const std::string& text) {
    return text.size() == 36 && text.find_first_not_of("0123456789abcdef-") == std::string::npos;
}

}  // namespace

/// Hops through a recording's entries.
class Recording::Scan {
public:
    explicit Scan(Recording& recording)
        : recording_(recording),
          file_(recording.file_),
          messages_(file_, conversion::recording_magic.size(), file_.size()) {}

    void run() {
        constexpr std::string_view magic = conversion::recording_magic;
        if (file_.size() < magic.size() || file_.read(0, magic.size()) != magic) file_.fail("not a recording");
        v1::RecordingEntry entry;
        if (!next(entry)) file_.fail("cut within its first entry: it holds nothing");
        if (!entry.has_begin()) file_.fail("its first entry is not its beginning");
        begin(entry.begin());
        while (next(entry) && take(entry)) {
        }
        recording_.cut_bytes_ = file_.size() - entry_at_;
    }

private:
    /// False at the end, or where the file was cut.
    bool next(v1::RecordingEntry& entry) {
        entry_at_ = messages_.position();
        const auto bytes = messages_.next(conversion::max_recording_entry_bytes);
        if (!bytes) return false;
        if (!entry.ParseFromString(*bytes)) fail("no entry of a recording");
        return true;
    }

    /// False where the file was cut within the messages that follow.
    bool take(const v1::RecordingEntry& entry) {
        switch (entry.entry_case()) {
            case v1::RecordingEntry::kBegin:
                fail("a second beginning");
            case v1::RecordingEntry::kParticles:
                return take(entry.particles());
            case v1::RecordingEntry::kMesh:
                return take(entry.mesh());
            case v1::RecordingEntry::ENTRY_NOT_SET:
                break;
        }
        fail("an entry of a kind that this version does not know");
    }

    void begin(const v1::RecordingBegin& begin) {
        if (begin.version() != conversion::recording_version)
            file_.fail("of format version " + std::to_string(begin.version()) + "; this program reads version " +
                       std::to_string(conversion::recording_version));
        if (!is_session_id(begin.session_id())) file_.fail("its session id is " + quote(begin.session_id()));
        try {
            recording_.settings_ = conversion::from_wire(begin.settings());
            validate(recording_.settings_);
        } catch (const InvalidInput& e) {
            file_.fail(e.what());
        }
        recording_.session_id_ = begin.session_id();
        recording_.started_at_ = time(begin.started_at());
    }

    bool take(const v1::RecordedParticles& particles) {
        std::vector<RecordedFrame>& frames = recording_.frames_;
        const std::string name = "frame " + std::to_string(particles.frame_index());
        if (!frames.empty() && particles.frame_index() <= frames.back().index)
            fail(name + " after frame " + std::to_string(frames.back().index) + "; indices must rise");
        if (!std::isfinite(particles.simulation_time()))
            fail(name + " has simulation time " + std::to_string(particles.simulation_time()));
        const Time arrived_at = time(particles.arrived_at());
        if (!frames.empty() && arrived_at < frames.back().arrived_at)
            fail(name + " arrived before frame " + std::to_string(frames.back().index));
        const auto range = messages_range(particles.bytes());
        if (!range) return false;
        frames.push_back({.index = particles.frame_index(),
                          .simulation_time = particles.simulation_time(),
                          .particle_count = particles.particle_count(),
                          .arrived_at = arrived_at,
                          .particles = *range,
                          .mesh = std::nullopt});
        return true;
    }

    bool take(const v1::RecordedMesh& mesh) {
        const auto range = messages_range(mesh.bytes());
        if (!range) return false;
        const auto frame = std::lower_bound(recording_.frames_.begin(), recording_.frames_.end(), mesh.frame_index(),
                                            [](const RecordedFrame& f, std::uint64_t index) { return f.index < index; });
        const std::string name = "frame " + std::to_string(mesh.frame_index());
        if (frame == recording_.frames_.end() || frame->index != mesh.frame_index())
            fail("the mesh of " + name + ", whose particles did not come before");
        if (frame->mesh) fail("a second mesh of " + name);
        frame->mesh = *range;
        return true;
    }

    /// Those that follow the entry; none if the file was cut within them.
    std::optional<ByteRange> messages_range(std::uint64_t size) {
        const std::uint64_t first = messages_.position();
        if (size > file_.size() - first) return std::nullopt;
        messages_.skip(size);
        return ByteRange{.first = first, .size = size};
    }

    Time time(std::int64_t microseconds) const {
        constexpr auto last = std::chrono::duration_cast<std::chrono::microseconds>(Time::max().time_since_epoch()).count();
        if (microseconds < 0 || microseconds > last)
            fail("a time of " + std::to_string(microseconds) + " microseconds since 1970; 0 to " + std::to_string(last) +
                 " are possible");
        return Time(std::chrono::duration_cast<Time::duration>(std::chrono::microseconds(microseconds)));
    }

    [[noreturn]] void fail(const std::string& what) const {
        file_.fail("at byte " + std::to_string(entry_at_) + ": " + what);
    }

    Recording& recording_;
    const RandomAccessFile& file_;
    DelimitedMessages messages_;
    std::uint64_t entry_at_ = 0;
};

Recording::Recording(const std::filesystem::path& path) : file_(path) {
    Scan(*this).run();
}

std::vector<RecordedFrame> Recording::frames(std::uint64_t first, std::uint64_t last) const {
    std::vector<RecordedFrame> selected;
    std::copy_if(frames_.begin(), frames_.end(), std::back_inserter(selected),
                 [&](const RecordedFrame& frame) { return frame.index >= first && frame.index <= last; });
    if (!selected.empty()) return selected;
    if (frames_.empty()) file_.fail("it holds no frame");
    file_.fail("no frame from " + std::to_string(first) + " to " + std::to_string(last) + "; it holds frames from " +
               std::to_string(frames_.front().index) + " to " + std::to_string(frames_.back().index));
}

RecordedParticles Recording::particles(const RecordedFrame& frame) const {
    return read_recorded_particles(file_, frame);
}

client::ReceivedFrame Recording::mesh(const RecordedFrame& frame) const {
    const std::string name = path().string() + ": mesh of frame " + std::to_string(frame.index);
    constexpr std::uint64_t limit = std::numeric_limits<int>::max();  // of protobuf's streams
    if (frame.mesh->size > limit)
        throw InvalidInput(name + ": " + std::to_string(frame.mesh->size) + " bytes; at most " + std::to_string(limit) +
                           " are read");
    client::ReceivedFrame mesh =
        read_bricks(name, file_.read(frame.mesh->first, static_cast<std::size_t>(frame.mesh->size)));
    if (mesh.index != frame.index) throw InvalidInput(name + ": it is that of frame " + std::to_string(mesh.index));
    return mesh;
}

std::vector<float> RecordedParticles::world_positions() const {
    if (quantized.empty()) return positions;
    std::vector<float> world(quantized.size());
    for (std::size_t i = 0; i < world.size(); ++i) {
        const double low = quantization_box.min[i % 3];
        const double extent = quantization_box.max[i % 3] - low;
        world[i] = static_cast<float>(low + static_cast<double>(quantized[i]) * extent / 65535.0);
    }
    return world;
}

}  // namespace meniscus::formats
