#include "formats/recordings/recording.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "formats/bytes/byte_cursor.hpp"
#include "formats/recordings/brick_file.hpp"
#include "formats/recordings/recorded_particles.hpp"
#include "formats/recordings/recorded_session.hpp"
#include "meniscus/error.hpp"
#include "meniscus/v1/recording.pb.h"

namespace meniscus::formats {
namespace {

using Time = std::chrono::system_clock::time_point;

bool is_session_id(const std::string& text) {
    return text.size() == 36 && text.find_first_not_of("0123456789abcdef-") == std::string::npos;
}

}  // namespace

/// Takes what the entries say, if it fits together.
class Recording::Scan {
public:
    explicit Scan(Recording& recording) : recording_(recording), file_(recording.file_), entries_(file_) {}

    void run() {
        begin(entries_.begin());
        while (const auto item = entries_.next()) {
            if (item->entry.has_particles())
                take(item->entry.particles(), item->messages);
            else
                take(item->entry.mesh(), item->messages);
        }
        recording_.has_checksums_ = entries_.has_checksums();
        recording_.cut_bytes_ = file_.size() - entries_.position();
    }

private:
    void begin(const v1::RecordingBegin& begin) {
        if (!is_session_id(begin.session_id())) file_.fail("its session id is " + quoted(begin.session_id()));
        try {
            recording_.settings_ = recorded_settings(begin);
        } catch (const InvalidInput& e) {
            file_.fail(e.what());
        }
        recording_.session_id_ = begin.session_id();
        recording_.started_at_ = time(begin.started_at());
        recording_.description_ = recorded_description(begin);
    }

    void take(const v1::RecordedParticles& particles, RecordedRange messages) {
        std::vector<RecordedFrame>& frames = recording_.frames_;
        const std::string name = "frame " + std::to_string(particles.frame_index());
        if (!frames.empty() && particles.frame_index() <= frames.back().index)
            entries_.fail(name + " after frame " + std::to_string(frames.back().index) + "; indices must rise");
        if (!std::isfinite(particles.simulation_time()))
            entries_.fail(name + " has simulation time " + std::to_string(particles.simulation_time()));
        const Time arrived_at = time(particles.arrived_at());
        if (!frames.empty() && arrived_at < frames.back().arrived_at)
            entries_.fail(name + " arrived before frame " + std::to_string(frames.back().index));
        frames.push_back({.index = particles.frame_index(),
                          .simulation_time = particles.simulation_time(),
                          .particle_count = particles.particle_count(),
                          .finished_bricks = particles.finished_bricks(),
                          .arrived_at = arrived_at,
                          .particles = messages,
                          .mesh = std::nullopt});
    }

    void take(const v1::RecordedMesh& mesh, RecordedRange messages) {
        const auto frame =
            std::lower_bound(recording_.frames_.begin(), recording_.frames_.end(), mesh.frame_index(),
                             [](const RecordedFrame& f, std::uint64_t index) { return f.index < index; });
        const std::string name = "frame " + std::to_string(mesh.frame_index());
        if (frame == recording_.frames_.end() || frame->index != mesh.frame_index())
            entries_.fail("the mesh of " + name + ", whose particles did not come before");
        if (frame->mesh) entries_.fail("a second mesh of " + name);
        frame->mesh = messages;
    }

    Time time(std::int64_t microseconds) const {
        constexpr auto last =
            std::chrono::duration_cast<std::chrono::microseconds>(Time::max().time_since_epoch()).count();
        if (microseconds < 0 || microseconds > last)
            entries_.fail("a time of " + std::to_string(microseconds) + " microseconds since 1970; 0 to " +
                          std::to_string(last) + " are possible");
        return Time(std::chrono::duration_cast<Time::duration>(std::chrono::microseconds(microseconds)));
    }

    Recording& recording_;
    const files::RandomAccessFile& file_;
    files::RecordingScan entries_;
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

bool Recording::is_whole(const RecordedFrame& frame) const {
    return files::is_whole(file_, frame.particles) && (!frame.mesh || files::is_whole(file_, *frame.mesh));
}

RecordedParticles Recording::particles(const RecordedFrame& frame) const {
    if (frame.finished_bricks) file_.fail(came_as_bricks(frame.index));
    if (!files::is_whole(file_, frame.particles))
        file_.fail("particles of frame " + std::to_string(frame.index) +
                   ": they do not have their checksum: the file is damaged");
    return read_recorded_particles(file_, frame);
}

client::ReceivedFrame Recording::mesh(const RecordedFrame& frame) const {
    const std::string name = path().string() + ": mesh of frame " + std::to_string(frame.index);
    constexpr std::uint64_t limit = std::numeric_limits<int>::max();  // of protobuf's streams
    if (frame.mesh->size > limit)
        throw InvalidInput(name + ": " + std::to_string(frame.mesh->size) + " bytes; at most " + std::to_string(limit) +
                           " are read");
    const std::string messages = file_.read(frame.mesh->first, static_cast<std::size_t>(frame.mesh->size));
    if (frame.mesh->checksum && *frame.mesh->checksum != files::checksum(messages))
        throw InvalidInput(name + ": it does not have its checksum: the file is damaged");
    client::ReceivedFrame mesh = read_brick_messages(name, messages);
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
