#include "files/recording_scan.hpp"

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
        file_.fail("of format version " + std::to_string(begin_.version()) + "; this program reads version " +
                   std::to_string(recording_version));
}

std::optional<RecordingScan::Item> RecordingScan::next() {
    entry_at_ = messages_.position();
    const auto bytes = messages_.next(max_recording_entry_bytes);
    if (!bytes) return std::nullopt;
    Item item;
    if (!item.entry.ParseFromString(*bytes)) fail("no entry of a recording");
    switch (item.entry.entry_case()) {
        case v1::RecordingEntry::kBegin:
            fail("a second beginning");
        case v1::RecordingEntry::kParticles:
            item.messages.size = item.entry.particles().bytes();
            break;
        case v1::RecordingEntry::kMesh:
            item.messages.size = item.entry.mesh().bytes();
            break;
        case v1::RecordingEntry::ENTRY_NOT_SET:
            fail("an entry of a kind that this version does not know");
    }
    item.messages.first = messages_.position();
    if (item.messages.size > file_.size() - item.messages.first) {
        go_on_at(entry_at_);
        return std::nullopt;
    }
    messages_.skip(item.messages.size);
    return item;
}

void RecordingScan::fail(const std::string& what) const {
    file_.fail("at byte " + std::to_string(entry_at_) + ": " + what);
}

}  // namespace meniscus::files
