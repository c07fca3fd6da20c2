// Hops from entry to entry of a recording; recording_format.hpp describes the file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "files/delimited_messages.hpp"
#include "files/random_access_file.hpp"
#include "files/recording_checksums.hpp"
#include "meniscus/v1/recording.pb.h"

namespace meniscus::files {

/// Reads entries, and not the messages that follow them. Throws InvalidInput, in one line that names file, byte and the
/// frame before, for everything that is wrong.
class RecordingScan {
public:
    /// The file outlives this object. Throws unless it begins as a recording of this version.
    explicit RecordingScan(const RandomAccessFile& file);

    const v1::RecordingBegin& begin() const noexcept { return begin_; }
    /// Whether damage to its entries and frames can be found.
    bool has_checksums() const noexcept { return has_checksums_; }

    struct Item {
        v1::RecordingEntry entry;  ///< particles or mesh
        RecordedRange messages;
    };
    /// The next entry with all of its messages, of a kind that this version knows; none at the end, or where the file
    /// is cut. Throws for what is no entry.
    std::optional<Item> next();

    /// Where the entry is that next() will return: a file that has grown since can be scanned from there on.
    std::uint64_t position() const noexcept { return messages_.position(); }
    /// position: as an earlier scan of this file had it.
    void go_on_at(std::uint64_t position) { messages_ = DelimitedMessages(file_, position, file_.size()); }

    /// Throws InvalidInput about the entry that next() has read last.
    [[noreturn]] void fail(const std::string& what) const;

private:
    const RandomAccessFile& file_;
    DelimitedMessages messages_;
    std::uint64_t entry_at_ = 0;
    v1::RecordingBegin begin_;
    bool has_checksums_ = false;
    std::optional<std::uint64_t> last_frame_;  ///< index, of the last good entry
};

}  // namespace meniscus::files
