#include "recording/recording_catalog.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <exception>
#include <optional>
#include <system_error>

#include "meniscus/error.hpp"
#include "process/log.hpp"
#include "recording/delete_recording.hpp"
#include "recording/recording_file.hpp"
#include "sessions/limits/refusal.hpp"

namespace meniscus::server {

namespace {

/// The number of a file NNNNNN.recording; none for another one.
std::optional<std::uint32_t> number_of(const std::filesystem::path& path) {
    const std::string stem = path.stem().string();
    std::uint32_t number = 0;
    std::from_chars(stem.data(), stem.data() + stem.size(), number);
    if (number == 0 || path.filename() != recording_file_name(number)) return std::nullopt;
    return number;
}

}  // namespace

void RecordingCatalog::scan(const std::function<void()>& go_on) {
    std::erase_if(entries_, [&](const auto& entry) {
        go_on();
        std::error_code error;
        return !std::filesystem::exists(entry.second.path, error);
    });
    for_each_file(go_on, [this](const RecordingName& name, const auto& file) { look_at(name, file); });
}

void RecordingCatalog::for_each_file(const std::function<void()>& go_on, const Visit& visit) const {
    std::error_code error;
    for (auto folder = std::filesystem::directory_iterator(directory_, error);
         !error && folder != std::filesystem::directory_iterator(); folder.increment(error)) {
        std::error_code inner;
        for (auto file = std::filesystem::directory_iterator(folder->path(), inner);
             !inner && file != std::filesystem::directory_iterator(); file.increment(inner)) {
            go_on();
            if (const auto number = number_of(file->path()))
                visit({.session_id = folder->path().filename().string(), .number = *number}, *file);
        }
    }
}

const RecordingCatalog::Entry* RecordingCatalog::look_at(const RecordingName& name,
                                                         const std::filesystem::directory_entry& file) {
    Entry& entry = entries_[name];
    std::error_code unknown;
    const RecordingIndex& index = entry.index;
    if (!entry.path.empty() && !index.being_written() && file.file_size(unknown) == index.bytes()) return &entry;
    entry.path = file.path();
    return refresh(name) ? &entry : nullptr;
}

RecordingCatalog::Opened RecordingCatalog::open(const RecordingName& name,
                                                const std::function<bool(const std::string& owner)>& may_see) {
    // One that has come since the last scan; one that is not there costs a look at one name.
    if (!entries_.contains(name) && name.number != 0)
        entries_[name].path = directory_ / name.session_id / recording_file_name(name.number);
    if (entries_.contains(name))
        if (auto file = refresh(name); file && may_see(entries_.at(name).index.begin().owner())) {
            Entry& entry = entries_.at(name);
            std::erase_if(entry.readers, [](const auto& reader) { return reader.expired(); });
            entry.readers.push_back(file);
            return {.file = std::move(file), .index = entry.index};
        }
    throw Refusal(Refusal::Kind::not_found,
                  fmt::format("no recording {} of session {}; ListRecordings tells which there are", name.number,
                              name.session_id));
}

bool RecordingCatalog::Entry::is_being_read() const {
    return std::ranges::any_of(readers, [](const auto& reader) { return !reader.expired(); });
}

void RecordingCatalog::remove(const RecordingName& name, const std::function<bool(const std::string& owner)>& may_see,
                              std::string_view reason) {
    const auto refuse = [&](const char* why) {
        throw Refusal(Refusal::Kind::failed_precondition,
                      fmt::format("recording {} of session {} is not deleted: {}", name.number, name.session_id, why));
    };
    const bool is_closed = open(name, may_see).file->is_closed();  // and so is not being read by this call any more
    const Entry& entry = entries_.at(name);
    if (entry.index.being_written())
        refuse("it is being written, until its session ends or sends a frame whose index does not rise");
    if (!is_closed) refuse("its file system keeps no locks, so that it may be being written; delete its file instead");
    if (entry.is_being_read()) refuse("it is being read; try again later");
    try {
        delete_recording(entry.path, name, entry.index.meshes().size(), entry.index.bytes(), reason);
    } catch (const std::system_error& error) {
        log_error({.session = name.session_id}, "{}", error.what());
        refuse(error.code().message().c_str());
    }
    entries_.erase(name);
}

void RecordingCatalog::tidy(const RecordingRetention& retention, std::filesystem::file_time_type now,
                            const std::function<void()>& go_on) {
    for_each_file(go_on, [&](const RecordingName& name, const std::filesystem::directory_entry& file) {
        const auto age = [&] {
            std::error_code gone;
            const auto written = file.last_write_time(gone);
            return gone ? std::filesystem::file_time_type::duration(0) : now - written;
        };
        const auto is_old = [&] { return retention.max_age.count() != 0 && age() >= retention.max_age; };
        if (retention.min_frames == 0 && !is_old()) return;
        const Entry* entry = look_at(name, file);
        if (entry == nullptr) return;
        // Nobody knows the number of frames that a damaged one had.
        const RecordingIndex& index = entry->index;
        const auto is_short = [&] { return !index.damaged() && index.meshes().size() < retention.min_frames; };
        if ((!is_short() && !is_old()) || !is_at_rest(name)) return;
        // It may have been written to, and closed, since it was looked at.
        if (!is_short() && !is_old()) return;
        const std::string reason = is_short()
                                       ? fewer_frames_than(retention.min_frames)
                                       : fmt::format("it was written {} s ago (--record-max-age)",
                                                     std::chrono::duration_cast<std::chrono::seconds>(age()).count());
        try {
            delete_recording(entry->path, name, index.meshes().size(), index.bytes(), reason);
            entries_.erase(name);
        } catch (const std::system_error& error) {
            if (const auto left = failures_.pass())
                log_error({.session = name.session_id}, "{}{}", error.what(), left_out(*left));
        }
    });
}

bool RecordingCatalog::is_at_rest(const RecordingName& name) {
    const auto file = refresh(name);
    if (!file || !file->is_closed() || entries_.at(name).is_being_read()) return false;
    return refresh(name) != nullptr;  // with what was written before it was closed
}

std::shared_ptr<const files::RandomAccessFile> RecordingCatalog::refresh(const RecordingName& name) {
    const auto entry = entries_.find(name);
    try {
        auto file = std::make_shared<const files::RandomAccessFile>(entry->second.path);
        entry->second.index.update(*file);
        if (entry->second.index.begin().session_id() == name.session_id) return file;
    } catch (const InvalidInput&) {
        // Not yet, or no more.
    }
    entries_.erase(entry);
    return nullptr;
}

}  // namespace meniscus::server
