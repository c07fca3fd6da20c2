#include "publishing/publication.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "conversion/settings_conversion.hpp"
#include "files/publication_format.hpp"
#include "files/publication_pace.hpp"
#include "files/publication_window.hpp"
#include "meniscus/error.hpp"
#include "meniscus/seconds.hpp"
#include "meniscus/sha256.hpp"

namespace meniscus::server {

namespace {

/// The ranges of all frames.
void widen(v1::MeshAttribute& known, const v1::MeshAttribute& by) {
    if (known.minimum_size() != by.minimum_size()) {
        if (known.minimum_size() != 0) return;  // `by` is of a mesh without vertices
        *known.mutable_minimum() = by.minimum();
        *known.mutable_maximum() = by.maximum();
        return;
    }
    for (int c = 0; c < known.minimum_size(); ++c) {
        known.set_minimum(c, std::min(known.minimum(c), by.minimum(c)));
        known.set_maximum(c, std::max(known.maximum(c), by.maximum(c)));
    }
}

/// The manifest has a form of its own: it leaves out the coding in bricks.
v1::MeshAttribute without_coding(v1::MeshAttribute attribute) {
    attribute.clear_bits();
    attribute.clear_coded_minimum();
    attribute.clear_coded_maximum();
    return attribute;
}

}  // namespace

Publication::Publication(std::string owner, const Settings& settings, const PublishingOptions& options,
                         std::shared_ptr<PublishingCounters> counters)
    : owner_(std::move(owner)),
      settings_(settings),
      keep_seconds_(options.keep.count() != 0 ? std::optional(seconds_of(options.keep)) : std::nullopt),
      limit_(options.limit != 0 ? options.limit : std::numeric_limits<std::size_t>::max()),
      counters_(std::move(counters)) {
    *manifest_.mutable_settings() = conversion::to_wire(settings_);
}

std::uint64_t Publication::begin(const v1::SessionDescription& description) {
    const std::lock_guard writing(writing_);
    if (!open_.empty()) end_segment(Clock::now());
    goes_on_ = false;
    last_at_.reset();
    const std::lock_guard lock(mutex_);
    *manifest_.mutable_description() = description;
    manifest_.set_live(true);
    change_manifest();
    ended_at_.reset();
    return ++turn_;
}

void Publication::add(std::uint64_t turn, const EncodedFrame& frame, Clock::time_point now) {
    const std::lock_guard writing(writing_);
    if (turn != turn_) return;
    if (!goes_on_) {
        const std::lock_guard lock(mutex_);
        // A session that was created anew is sent again what had no answer.
        if (has(frame.run_id, frame.index)) return;
    }
    goes_on_ = true;
    try {
        append(frame, now);
    } catch (...) {
        open_ = {};  // it may have half a frame
        throw;
    }
    if (!open_.empty() && (open_.bytes() >= files::segment_bytes || now - opened_at_ >= files::segment_time))
        end_segment(now);
}

void Publication::append(const EncodedFrame& frame, Clock::time_point now) {
    static const WatchOptions form{.format = {}, .spray = true};
    if (!open_.empty() && (open_run_ != frame.run_id || open_.last_index() >= frame.index)) end_segment(now);
    FrameUpdate update = update_mesh(frame, form, open_.empty() ? nullptr : &base_);
    if (!open_.empty() && open_.bytes() + update.bytes > most_frame_bytes()) {
        end_segment(now);
        update = update_mesh(frame, form, nullptr);
    }
    if (update.bytes > most_frame_bytes()) {
        ++counters_->left_out;
        throw LimitExceeded(
            fmt::format("it has {} bytes; --publish-limit has room for {}", update.bytes, most_frame_bytes()));
    }
    if (open_.empty()) {
        open_run_ = frame.run_id;
        open_seconds_ = 0.0;
        opened_at_ = now;
    }
    open_.begin_frame(frame.index, frame.simulation_time);
    for (const SharedMessage& message : update.messages) open_.add(*message);
    base_ = std::move(update.result);
    open_seconds_ += files::shown_seconds(last_at_ ? std::optional(now - *last_at_) : std::nullopt);
    last_at_ = now;
    if (frame.attributes.empty()) return;
    const std::lock_guard lock(mutex_);
    take_attributes(frame);
}

void Publication::end_segment(Clock::time_point now) {
    files::SegmentFile::Built built = open_.build();
    built.entry.set_run_id(open_run_);
    built.entry.set_seconds(open_seconds_);
    auto file = std::make_shared<const PublishedFile>(std::move(built.bytes), built.entry.sha256(), counters_);
    counters_->frames += built.entry.frames();
    counters_->bytes += file->bytes.size();
    const std::lock_guard lock(mutex_);
    bytes_ += file->bytes.size();
    segments_.push_back({.entry = std::move(built.entry), .file = std::move(file)});
    change_manifest();
    const auto first = std::ranges::find_if(segments_, &Segment::is_listed);
    const auto listed = [first](std::size_t i) -> Segment& { return first[static_cast<std::ptrdiff_t>(i)]; };
    const std::size_t old = files::segments_beyond(static_cast<std::size_t>(segments_.end() - first), keep_seconds_,
                                                   [&](std::size_t i) { return listed(i).entry.seconds(); });
    for (std::size_t i = 0; i < old; ++i) leave(listed(i), now);
    // Before a reader sees the new one beside them.
    while (bytes_ > limit_) remove_oldest();
}

void Publication::end(std::uint64_t turn, Clock::time_point now) {
    const std::lock_guard writing(writing_);
    if (turn != turn_) return;
    if (!open_.empty()) end_segment(now);
    base_ = {};
    const std::lock_guard lock(mutex_);
    if (ended_at_) return;
    ended_at_ = now;
    manifest_.set_live(false);
    change_manifest();
}

void Publication::tidy(Clock::time_point now) {
    const std::lock_guard writing(writing_);
    if (!open_.empty() && now - opened_at_ >= files::segment_time) end_segment(now);
    const std::lock_guard lock(mutex_);
    while (!segments_.empty() && segments_.front().left_at &&
           now - *segments_.front().left_at >= files::readers_delay) {
        bytes_ -= segments_.front().file->bytes.size();
        segments_.pop_front();
    }
}

std::optional<Publication::Clock::duration> Publication::ended_for(Clock::time_point now) const {
    const std::lock_guard lock(mutex_);
    if (!ended_at_) return std::nullopt;
    return now - *ended_at_;
}

std::size_t Publication::bytes() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
}

void Publication::drop_oldest() {
    const std::lock_guard lock(mutex_);
    if (!segments_.empty()) remove_oldest();
}

void Publication::remove_oldest() {
    Segment& oldest = segments_.front();
    if (oldest.is_listed()) {
        counters_->left_out += oldest.entry.frames();
        leave(oldest, {});
    }
    bytes_ -= oldest.file->bytes.size();
    segments_.pop_front();
}

std::shared_ptr<const PublishedFile> Publication::find(std::string_view name) const {
    if (name == files::manifest_name) return manifest_file();
    const std::lock_guard lock(mutex_);
    if (!name.ends_with(files::segment_extension)) return nullptr;
    name.remove_suffix(files::segment_extension.size());
    const auto found =
        std::ranges::find_if(segments_, [&](const Segment& segment) { return segment.file->sha256 == name; });
    return found != segments_.end() ? found->file : nullptr;
}

std::shared_ptr<const PublishedFile> Publication::manifest_file() const {
    v1::Publication wire;
    std::uint64_t changes = 0;
    {
        const std::lock_guard lock(mutex_);
        if (manifest_file_) return manifest_file_;
        wire = whole_manifest();
        changes = changes_;
    }
    // Without the lock, which every frame takes: a long window is many lines.
    std::string text = files::manifest_json(std::move(wire));
    std::string sha256 = sha256_of(text);
    auto file = std::make_shared<const PublishedFile>(std::move(text), std::move(sha256), counters_);
    const std::lock_guard lock(mutex_);
    if (changes == changes_) manifest_file_ = file;
    return file;
}

v1::Publication Publication::whole_manifest() const {
    v1::Publication wire = manifest_;
    std::uint64_t frames = 0;
    std::uint64_t bytes = 0;
    for (const Segment& segment : segments_) {
        if (!segment.is_listed()) continue;
        *wire.add_segments() = segment.entry;
        frames += segment.entry.frames();
        bytes += segment.entry.bytes();
    }
    wire.set_frames(frames);
    wire.set_bytes(bytes);
    return wire;
}

void Publication::change_manifest() noexcept {
    ++changes_;
    manifest_file_.reset();
}

void Publication::leave(Segment& segment, Clock::time_point now) {
    segment.left_at = now;
    manifest_.set_left_frames(manifest_.left_frames() + segment.entry.frames());
    change_manifest();
}

void Publication::take_attributes(const EncodedFrame& frame) {
    for (const v1::MeshAttribute& attribute : frame.attributes) {
        if (!attribute.has_bits()) continue;  // the bricks do not carry it
        auto& known = *manifest_.mutable_attributes();
        const auto found =
            std::ranges::find_if(known, [&](const auto& other) { return other.name() == attribute.name(); });
        if (found == known.end())
            *known.Add() = without_coding(attribute);
        else
            widen(*found, attribute);
    }
}

bool Publication::has(std::uint64_t run_id, std::uint64_t index) const {
    return run_id != 0 && std::ranges::any_of(segments_, [&](const Segment& segment) {
               return segment.entry.run_id() == run_id && segment.entry.last_frame() >= index;
           });
}

}  // namespace meniscus::server
