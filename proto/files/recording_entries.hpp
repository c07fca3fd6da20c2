// What the entries of a recording say, wherever their bytes come from: a file, or a pipe.
#pragma once

#include <string>

#include "meniscus/v1/recording.pb.h"

namespace meniscus::files {

struct RecordingBeginning {
    v1::RecordingBegin begin;
    bool has_checksums = false;  ///< then every entry has one
};

/// Reads the first entry. Throws InvalidInput, here and below, in words that name no place.
RecordingBeginning read_beginning(const std::string& bytes);

/// Reads a later entry. One of a kind that this version does not know has none of its own fields set.
v1::RecordingEntry read_entry(const std::string& bytes, bool has_checksums);

/// Whether this version knows the entry's kind. Readers skip an entry of another, and the messages that follow it.
inline bool is_known(const v1::RecordingEntry& entry) {
    return entry.entry_case() != v1::RecordingEntry::ENTRY_NOT_SET;
}

}  // namespace meniscus::files
