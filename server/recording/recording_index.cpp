#include "recording/recording_index.hpp"

#include "meniscus/error.hpp"
#include "process/log.hpp"

namespace meniscus::server {

void RecordingIndex::update(const files::RandomAccessFile& file) {
    files::RecordingScan scan(file);
    if (file.size() < position_ || scan.begin().SerializeAsString() != begin_.SerializeAsString()) {
        *this = {};
        begin_ = scan.begin();
        position_ = scan.position();
    }
    bytes_ = file.size();
    being_written_ = file.being_written();
    if (damaged_) return;
    scan.go_on_at(position_);
    try {
        while (const auto item = scan.next()) {
            take(scan, *item);
            position_ = scan.position();
        }
    } catch (const InvalidInput& error) {
        damaged_ = true;
        log_warning({.session = begin_.session_id()}, "a recording can be read up to its frame {} only: {}",
                    meshes_.empty() ? "none" : std::to_string(meshes_.back().frame_index), error.what());
    }
}

void RecordingIndex::take(const files::RecordingScan& scan, const files::RecordingScan::Item& item) {
    if (!item.entry.has_mesh()) return;
    const std::uint64_t index = item.entry.mesh().frame_index();
    if (!meshes_.empty() && index <= meshes_.back().frame_index)
        scan.fail("the mesh of frame " + std::to_string(index) + " after that of frame " +
                  std::to_string(meshes_.back().frame_index) + "; indices must rise");
    meshes_.push_back({.frame_index = index, .messages = item.messages});
}

}  // namespace meniscus::server
