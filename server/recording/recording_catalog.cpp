#include "recording/recording_catalog.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <system_error>

#include "meniscus/error.hpp"
#include "recording/recording_file.hpp"
#include "sessions/refusal.hpp"

namespace meniscus::server {

namespace {

/// Of a file NNNNNN.recording.
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
    std::error_code error;
    for (auto i = std::filesystem::directory_iterator(directory_, error);
         !error && i != std::filesystem::directory_iterator(); i.increment(error))
        look_into(i->path(), go_on);
}

void RecordingCatalog::look_into(const std::filesystem::path& session_folder, const std::function<void()>& go_on) {
    std::error_code error;
    for (auto i = std::filesystem::directory_iterator(session_folder, error);
         !error && i != std::filesystem::directory_iterator(); i.increment(error)) {
        go_on();
        const auto number = number_of(i->path());
        if (!number) continue;
        const RecordingName name{.session_id = session_folder.filename().string(), .number = *number};
        Entry& entry = entries_[name];
        std::error_code unknown;
        const RecordingIndex& index = entry.index;
        if (!entry.path.empty() && !index.being_written() && i->file_size(unknown) == index.bytes()) continue;
        entry.path = i->path();
        refresh(name);
    }
}

RecordingCatalog::Opened RecordingCatalog::open(const RecordingName& name,
                                                const std::function<bool(const std::string& owner)>& may_see) {
    // One that has come since the last scan; one that is not there costs a look at one name.
    if (!entries_.contains(name) && name.number != 0)
        entries_[name].path = directory_ / name.session_id / recording_file_name(name.number);
    if (entries_.contains(name))
        if (auto file = refresh(name); file && may_see(entries_.at(name).index.begin().owner()))
            return {.file = std::move(file), .index = entries_.at(name).index};
    throw Refusal(Refusal::Kind::not_found,
                  fmt::format("no recording {} of session {}; ListRecordings tells which there are", name.number,
                              name.session_id));
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
