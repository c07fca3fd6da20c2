// The recordings in a folder: a request names a session and a number, never a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "files/random_access_file.hpp"
#include "process/line_limit.hpp"
#include "recording/recording_index.hpp"
#include "recording/recording_name.hpp"
#include "recording/recording_options.hpp"

namespace meniscus::server {

/// Blocks on the disk; of one thread.
class RecordingCatalog {
public:
    explicit RecordingCatalog(std::filesystem::path directory) : directory_(std::move(directory)) {}

    struct Entry {
        std::filesystem::path path;
        RecordingIndex index;
        /// The files that open() gave to those that read them now.
        std::vector<std::weak_ptr<const files::RandomAccessFile>> readers{};

        bool is_being_read() const;
    };
    using Entries = std::map<RecordingName, Entry>;
    /// Looks for all that can be read now. A file without a recording's beginning is none, nor is one in another
    /// session's folder. go_on: asked before each file; what it throws ends this.
    void scan(const std::function<void()>& go_on);
    /// The recordings that the last scan() found, or that were opened since.
    const Entries& known() const noexcept { return entries_; }

    struct Opened {
        std::shared_ptr<const files::RandomAccessFile> file;
        const RecordingIndex& index;  ///< as the file is now; until the next call
    };
    /// name: its session's id is a UUID, as the edge has verified. may_see: whether the recordings of this owner exist
    /// for the caller. Throws Refusal, not_found, if there is no
    /// such recording for it.
    Opened open(const RecordingName& name, const std::function<bool(const std::string& owner)>& may_see);

    /// Deletes it, with a line in the log that has the reason. Throws Refusal as open(), and failed_precondition while
    /// it is being written or read.
    void remove(const RecordingName& name, const std::function<bool(const std::string& owner)>& may_see,
                std::string_view reason);
    /// Deletes those that are not to be kept, but for what is being written or read. now: by the clock of the files'
    /// times. go_on: as of scan(). A file that cannot be deleted is logged, and left.
    void tidy(const RecordingRetention& retention, std::filesystem::file_time_type now,
              const std::function<void()>& go_on);

private:
    using Visit = std::function<void(const RecordingName& name, const std::filesystem::directory_entry& file)>;
    /// Every file in the folder that may be a recording.
    void for_each_file(const std::function<void()>& go_on, const Visit& visit) const;
    /// Brings its entry up to date. None if it is no recording.
    const Entry* look_at(const RecordingName& name, const std::filesystem::directory_entry& file);
    /// Whether it is neither being written nor read; its entry then has all that it will ever hold.
    bool is_at_rest(const RecordingName& name);
    /// Opens the file and brings the entry up to date; forgets the entry and returns none if it is no recording any
    /// more.
    std::shared_ptr<const files::RandomAccessFile> refresh(const RecordingName& name);

    const std::filesystem::path directory_;
    Entries entries_;
    LineLimit failures_{10};  ///< to delete
};

}  // namespace meniscus::server
