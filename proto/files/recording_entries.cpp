#include "files/recording_entries.hpp"

#include <google/protobuf/unknown_field_set.h>

#include "files/recording_checksums.hpp"
#include "files/recording_format.hpp"
#include "meniscus/error.hpp"

namespace meniscus::files {
namespace {

v1::RecordingEntry parsed(const std::string& bytes) {
    v1::RecordingEntry entry;
    if (!entry.ParseFromString(bytes)) throw InvalidInput("no entry of a recording");
    return entry;
}

void require_sealed(const std::string& bytes, const v1::RecordingEntry& entry, bool has_checksums) {
    if ((has_checksums || entry.has_checksum()) && !is_sealed(bytes))
        throw InvalidInput("an entry that does not have its checksum: the file is damaged");
}

}  // namespace

RecordingBeginning read_beginning(const std::string& bytes) {
    const v1::RecordingEntry entry = parsed(bytes);
    if (!entry.has_begin()) throw InvalidInput("its first entry is not its beginning");
    if (entry.begin().version() != recording_version)
        throw InvalidInput("a recording of format version " + std::to_string(entry.begin().version()) +
                           "; this program reads version " + std::to_string(recording_version) +
                           ": read it with the Meniscus that wrote it");
    require_sealed(bytes, entry, false);
    return {entry.begin(), entry.has_checksum()};
}

v1::RecordingEntry read_entry(const std::string& bytes, bool has_checksums) {
    v1::RecordingEntry entry = parsed(bytes);
    if (entry.has_begin()) throw InvalidInput("a second beginning");
    // An entry of a later version has fields that this one does not know. An empty entry is a run of zeros, as some
    // file systems leave them after a crash.
    if (!is_known(entry) && v1::RecordingEntry::GetReflection()->GetUnknownFields(entry).empty())
        throw InvalidInput("an entry of no kind");
    require_sealed(bytes, entry, has_checksums);
    return entry;
}

}  // namespace meniscus::files
