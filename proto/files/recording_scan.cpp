#include "files/recording_scan.hpp"

#include <utility>

#include "files/recording_entries.hpp"
#include "files/recording_format.hpp"
#include "meniscus/error.hpp"

namespace meniscus::files {

RecordingScan::RecordingScan(const RandomAccessFile& file)
    : file_(file), messages_(file, recording_magic.size(), file.size()) {
    if (file_.size() < recording_magic.size() || file_.read(0, recording_magic.size()) != recording_magic)
        file_.fail("not a recording");
    entry_at_ = messages_.position();
    const auto bytes = messages_.next(max_recording_entry_bytes);
    if (!bytes) file_.fail("cut within its first entry: it holds nothing");
    try {
        RecordingBeginning beginning = read_beginning(*bytes);
        begin_ = std::move(beginning.begin);
        has_checksums_ = beginning.has_checksums;
    } catch (const InvalidInput& e) {
        file_.fail(e.what());
    }
}

std::optional<RecordingScan::Item> RecordingScan::next() {
    while (true) {
        entry_at_ = messages_.position();
        const auto bytes = messages_.next(max_recording_entry_bytes);
        if (!bytes) return std::nullopt;
        Item item;
        try {
            item.entry = read_entry(*bytes, has_checksums_);
        } catch (const InvalidInput& e) {
            fail(e.what());
        }
        item.messages = {.first = messages_.position(), .size = item.entry.bytes(), .checksum = std::nullopt};
        if (item.entry.has_messages_checksum()) item.messages.checksum = item.entry.messages_checksum();
        if (item.messages.size > file_.size() - item.messages.first) {
            go_on_at(entry_at_);
            return std::nullopt;
        }
        messages_.skip(item.messages.size);
        if (!is_known(item.entry)) continue;
        last_frame_ = item.entry.has_mesh() ? item.entry.mesh().frame_index() : item.entry.particles().frame_index();
        return item;
    }
}

void RecordingScan::fail(const std::string& what) const {
    const std::string behind = last_frame_ ? ", behind an entry of frame " + std::to_string(*last_frame_) : "";
    file_.fail("at byte " + std::to_string(entry_at_) + behind + ": " + what);
}

}  // namespace meniscus::files
