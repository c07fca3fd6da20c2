// The recordings in a folder: a request names a session and a number, never a file.
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "files/random_access_file.hpp"
#include "recording/recording_index.hpp"

namespace meniscus::server {

struct RecordingName {
    std::string session_id;
    std::uint32_t number = 0;
    auto operator<=>(const RecordingName&) const =
        default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 means what the compiler writes here
};

/// Blocks on the disk; of one thread.
class RecordingCatalog {
public:
    explicit RecordingCatalog(std::filesystem::path directory) : directory_(std::move(directory)) {}

    struct Entry {
        std::filesystem::path path;
        RecordingIndex index;
    };
    using Entries = std::map<RecordingName, Entry>;
    /// Looks for all that can be read now. A file without a recording's beginning is none, nor is one in another
    /// session's folder. go_on: asked before each file; what it throws ends this.
    void scan(const std::function<void()>& go_on);
    /// By the last scan(), and what was opened since.
    const Entries& known() const noexcept { return entries_; }

    struct Opened {
        std::shared_ptr<const files::RandomAccessFile> file;
        const RecordingIndex& index;  ///< as the file is now; until the next call
    };
    /// name: its session's id is a UUID, as the edge has verified. may_see: whether the recordings of this owner exist
    /// for the caller. Throws Refusal, not_found, if there is no
    /// such recording for it.
    Opened open(const RecordingName& name, const std::function<bool(const std::string& owner)>& may_see);

private:
    void look_into(const std::filesystem::path& session_folder, const std::function<void()>& go_on);
    /// Opens the file and brings the entry up to date; forgets the entry and returns none if it is no recording any
    /// more.
    std::shared_ptr<const files::RandomAccessFile> refresh(const RecordingName& name);

    const std::filesystem::path directory_;
    Entries entries_;
};

}  // namespace meniscus::server
