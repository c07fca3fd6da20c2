#include "meniscus/client/publication_writer.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "files/publication_format.hpp"
#include "files/publication_window.hpp"
#include "meniscus/error.hpp"
#include "publications/durable_file.hpp"
#include "publications/folder_lock.hpp"
#include "publications/manifest.hpp"
#include "publications/segment.hpp"

namespace meniscus::client {
namespace {

using Clock = std::chrono::steady_clock;

std::filesystem::path made(std::filesystem::path folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw InvalidInput(folder.string() + ": cannot be made a folder: " + error.message());
    return folder;
}

void widen(AttributeRange& range, const AttributeRange& by) {
    for (std::size_t c = 0; c < max_attribute_components; ++c) {
        range.minimum[c] = std::min(range.minimum[c], by.minimum[c]);
        range.maximum[c] = std::max(range.maximum[c], by.maximum[c]);
    }
}

/// The file of a segment, whole or half.
bool is_segment_file(const std::filesystem::path& path) {
    const std::filesystem::path whole = path.extension() == ".partial" ? path.stem() : path.filename();
    return whole.extension() == files::segment_extension && whole.stem().string().size() == 64;
}

}  // namespace

class PublicationWriter::Impl {
public:
    Impl(std::filesystem::path folder, const std::optional<Settings>& settings, const PublishOptions& options)
        : folder_(made(std::move(folder))), lock_(folder_), options_(options) {
        // As they are read back.
        const std::optional<Settings> spelled_out = settings ? std::optional(in_force(*settings)) : std::nullopt;
        if (is_publication(folder_))
            go_on(spelled_out);
        else
            begin(spelled_out);
        write_manifest();
        remove_strangers();
    }

    const PublicationInfo& info() const noexcept { return info_; }
    bool is_open() const noexcept { return !open_.empty(); }

    bool has(std::uint64_t run_id, std::uint64_t index) const noexcept {
        return std::ranges::any_of(info_.segments, [&](const PublishedSegment& segment) {
            return segment.run_id == run_id && segment.last_frame >= index;
        });
    }

    void add(const ReceivedFrame& frame, double seconds) {
        if (!open_.can_follow(frame)) flush();
        if (!open_.add(frame, seconds)) {
            flush();
            (void)open_.add(frame, seconds);
        }
        take_attributes(frame);
        if (open_.bytes() >= options_.segment_bytes || open_.seconds() >= options_.segment_seconds) flush();
    }

    void flush() {
        if (open_.empty()) return;
        require_room();
        SegmentBuilder::Built built = open_.build();
        write_durably(folder_ / built.segment.file(), built.bytes);
        info_.frames += built.segment.frames;
        info_.bytes += built.segment.bytes;
        info_.segments.push_back(std::move(built.segment));
        drop_old();
        write_manifest();
        remove_dropped(Clock::now() - files::readers_delay);
    }

    void finish() {
        flush();
        info_.live = false;
        write_manifest();
        remove_dropped(Clock::time_point::max());
    }

private:
    void begin(const std::optional<Settings>& settings) {
        info_.settings = settings;
        info_.description = options_.description;
        info_.normals_by = options_.normals_by;
        info_.live = options_.live;
    }

    void go_on(const std::optional<Settings>& settings) {
        info_ = Publication(folder_).info();
        if (info_.settings != settings)
            throw InvalidInput(folder_.string() +
                               ": the publication there has other settings: take another folder, "
                               "or the settings that its " +
                               std::string(files::manifest_name) + " names");
        if (info_.normals_by != options_.normals_by)
            throw InvalidInput(folder_.string() + ": the publication there has normals by the " +
                               std::string(name_of(info_.normals_by)) + ": take another folder, or --normals-by " +
                               std::string(name_of(info_.normals_by)));
        info_.live = options_.live;
    }

    void take_attributes(const ReceivedFrame& frame) {
        for (const CodedAttribute& coded : frame.coded_attributes) {
            const auto announced = std::ranges::find(frame.attributes, coded.name, &FrameAttribute::name);
            if (announced == frame.attributes.end()) continue;
            const auto known = std::ranges::find(info_.attributes, coded.name, &FrameAttribute::name);
            if (known == info_.attributes.end())
                info_.attributes.push_back(*announced);
            else if (announced->range && known->range)
                widen(*known->range, *announced->range);
            else if (announced->range)
                known->range = announced->range;
        }
    }

    /// What is to be kept for ever does not leave for want of room in the manifest.
    void require_room() const {
        if (options_.keep_seconds || info_.segments.size() < files::max_segments) return;
        throw LimitExceeded(folder_.string() + ": it has " + std::to_string(files::max_segments) +
                            " segments, and a manifest lists no more: publish what follows to another folder, or keep "
                            "the newest seconds alone");
    }

    /// Leaves segments out of the manifest that are older than the seconds that are kept.
    void drop_old() {
        if (!options_.keep_seconds) return;
        const std::size_t first = files::segments_beyond(info_.segments.size(), options_.keep_seconds,
                                                         [this](std::size_t i) { return info_.segments[i].seconds; });
        for (std::size_t i = 0; i < first; ++i) {
            const PublishedSegment& segment = info_.segments[i];
            info_.left_frames += segment.frames;
            info_.frames -= segment.frames;
            info_.bytes -= segment.bytes;
            dropped_.push_back({Clock::now(), segment.file()});
        }
        info_.segments.erase(info_.segments.begin(), info_.segments.begin() + static_cast<std::ptrdiff_t>(first));
    }

    void write_manifest() { write_durably(folder_ / files::manifest_name, manifest_text(info_)); }

    bool is_listed(const std::string& file) const {
        return std::ranges::any_of(info_.segments, [&](const auto& segment) { return segment.file() == file; });
    }

    void remove_dropped(Clock::time_point before) {
        for (; !dropped_.empty() && dropped_.front().at <= before; dropped_.pop_front()) {
            std::error_code ignored;
            if (!is_listed(dropped_.front().file)) std::filesystem::remove(folder_ / dropped_.front().file, ignored);
        }
    }

    /// Removes files that a killed writer has made and not listed.
    void remove_strangers() {
        std::error_code ignored;
        for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored))
            if (is_segment_file(entry.path()) && !is_listed(entry.path().filename().string()))
                std::filesystem::remove(entry.path(), ignored);
    }

    struct Dropped {
        Clock::time_point at;
        std::string file;
    };

    std::filesystem::path folder_;
    FolderLock lock_;
    PublishOptions options_;
    PublicationInfo info_;
    SegmentBuilder open_;
    std::deque<Dropped> dropped_;
};

PublicationWriter::PublicationWriter(std::filesystem::path folder, const std::optional<Settings>& settings,
                                     const PublishOptions& options)
    : impl_(std::make_unique<Impl>(std::move(folder), settings, options)) {}
PublicationWriter::~PublicationWriter() = default;

const PublicationInfo& PublicationWriter::info() const noexcept {
    return impl_->info();
}

bool PublicationWriter::has(std::uint64_t run_id, std::uint64_t index) const noexcept {
    return impl_->has(run_id, index);
}

void PublicationWriter::add(const ReceivedFrame& frame, double seconds) {
    impl_->add(frame, seconds);
}

bool PublicationWriter::is_open() const noexcept {
    return impl_->is_open();
}

void PublicationWriter::flush() {
    impl_->flush();
}

void PublicationWriter::finish() {
    impl_->finish();
}

}  // namespace meniscus::client
