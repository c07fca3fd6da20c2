#include "files/recording_scan.hpp"

#include <google/protobuf/unknown_field_set.h>

#include "files/recording_format.hpp"

namespace meniscus::files {

RecordingScan::RecordingScan(const RandomAccessFile& file)
    : file_(file), messages_(file, recording_magic.size(), file.size()) {
    if (file_.size() < recording_magic.size() || file_.read(0, recording_magic.size()) != recording_magic)
        file_.fail("not a recording");
    entry_at_ = messages_.position();
    const auto bytes = messages_.next(max_recording_entry_bytes);
    if (!bytes) file_.fail("cut within its first entry: it holds nothing");
    v1::RecordingEntry entry;
    if (!entry.ParseFromString(*bytes)) fail("no entry of a recording");
    if (!entry.has_begin()) file_.fail("its first entry is not its beginning");
    begin_ = entry.begin();
    if (begin_.version() != recording_version)
        file_.fail("a recording of format version " + std::to_string(begin_.version()) +
                   "; this program reads version " + std::to_string(recording_version) +
                   ": read it with the Meniscus that wrote it");
    has_checksums_ = entry.has_checksum();
    require_sealed(*bytes, entry);
}

std::optional<RecordingScan::Item> RecordingScan::next() {
    while (true) {
        entry_at_ = messages_.position();
        const auto bytes = messages_.next(max_recording_entry_bytes);
        if (!bytes) return std::nullopt;
        Item item;
        if (!item.entry.ParseFromString(*bytes)) fail("no entry of a recording");
        if (item.entry.has_begin()) fail("a second beginning");
        const bool known = item.entry.entry_case() != v1::RecordingEntry::ENTRY_NOT_SET;
        // An entry of a later version has fields that this one does not know. An empty entry is a run of zeros, as some
        // file systems leave them after a crash.
        if (!known && v1::RecordingEntry::GetReflection()->GetUnknownFields(item.entry).empty())
            fail("an entry of no kind");
        require_sealed(*bytes, item.entry);
        item.messages = {.first = messages_.position(), .size = item.entry.bytes(), .checksum = std::nullopt};
        if (item.entry.has_messages_checksum()) item.messages.checksum = item.entry.messages_checksum();
        if (item.messages.size > file_.size() - item.messages.first) {
            go_on_at(entry_at_);
            return std::nullopt;
        }
        messages_.skip(item.messages.size);
        if (!known) continue;
        last_frame_ = item.entry.has_mesh() ? item.entry.mesh().frame_index() : item.entry.particles().frame_index();
        return item;
    }
}

void RecordingScan::require_sealed(const std::string& bytes, const v1::RecordingEntry& entry) const {
    if ((has_checksums_ || entry.has_checksum()) && !is_sealed(bytes))
        fail("an entry that does not have its checksum: the file is damaged");
}

void RecordingScan::fail(const std::string& what) const {
    const std::string behind = last_frame_ ? ", behind an entry of frame " + std::to_string(*last_frame_) : "";
    file_.fail("at byte " + std::to_string(entry_at_) + behind + ": " + what);
}

}  // namespace meniscus::files
