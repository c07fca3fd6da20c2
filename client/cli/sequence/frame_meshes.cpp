#include "cli/sequence/frame_meshes.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>
#include <vector>

#include "cli/sequence/recording_files.hpp"
#include "meniscus/client/publication.hpp"
#include "meniscus/error.hpp"

namespace meniscus::cli {
namespace {

std::string frame_name(const std::filesystem::path& path, std::uint64_t index) {
    return path.string() + ": frame " + std::to_string(index);
}

[[noreturn]] void refuse_range(const std::filesystem::path& path, const FrameRange& range) {
    throw InvalidInput(path.string() + ": no mesh of a frame" +
                       (range.first == range.last
                            ? " " + std::to_string(range.first)
                            : "s from " + std::to_string(range.first) + " to " + std::to_string(range.last)));
}

/// The frames of a publication that grows are other ones for the next share, and of two runs a frame of one name each
/// may be in two shares.
void take_share(const client::Publication& publication, const Share& share, std::vector<std::uint64_t>& places) {
    const client::PublicationInfo& info = publication.info();
    if (info.live)
        throw InvalidInput(publication.name() + ": --share is of frames that are all there, and more frames may come");
    if (std::ranges::any_of(info.segments, [&](const client::PublishedSegment& segment) {
            return segment.run_id != info.segments.front().run_id;
        }))
        throw InvalidInput(publication.name() + ": --share is of frames of one run, and it has several runs");
    share.keep(places);
}

void for_each_published(const std::filesystem::path& path, const FrameRange& range, const TakeFrame& take) {
    client::Publication publication(path);
    std::uint64_t place = publication.info().left_frames;
    std::vector<std::uint64_t> places;
    for (const client::PublishedSegment& segment : publication.info().segments) {
        const std::uint64_t end = place + segment.frames;
        if (segment.last_frame < range.first || segment.first_frame > range.last) place = end;
        for (; place < end; ++place) places.push_back(place);
    }
    if (places.empty()) refuse_range(path, range);
    if (range.share) take_share(publication, *range.share, places);
    bool any = range.share.has_value();
    for (const std::uint64_t each : places) {
        const client::ReceivedFrame frame = publication.frame(each);
        if (frame.index < range.first || frame.index > range.last) continue;
        take(frame_name(path, frame.index), frame);
        any = true;
    }
    if (!any) refuse_range(path, range);
}

void for_each_recorded(const std::filesystem::path& path, const FrameRange& range, const TakeFrame& take) {
    RecordingSelection selection;
    selection.path = path.string();
    const formats::Recording recording = selection.open();
    auto frames = recording.frames(range.first, range.last);
    std::erase_if(frames, [](const formats::RecordedFrame& frame) { return !frame.mesh; });
    if (frames.empty()) refuse_range(path, range);
    if (range.share) range.share->keep(frames);
    for (const formats::RecordedFrame& frame : frames) take(frame_name(path, frame.index), recording.mesh(frame));
}

client::ReceivedFrame newest_published(const std::filesystem::path& path) {
    client::Publication publication(path);
    const client::PublicationInfo& info = publication.info();
    if (info.frames == 0) throw InvalidInput(path.string() + ": it holds no frame yet");
    return publication.frame(info.left_frames + info.frames - 1);
}

client::ReceivedFrame newest_recorded(const std::filesystem::path& path) {
    RecordingSelection selection;
    selection.path = path.string();
    const formats::Recording recording = selection.open();
    for (auto frame = recording.frames().rbegin(); frame != recording.frames().rend(); ++frame)
        if (frame->mesh) return recording.mesh(*frame);
    throw InvalidInput(path.string() + ": it holds no mesh");
}

}  // namespace

bool has_frames(const std::filesystem::path& path) {
    return client::is_publication(path) || is_recording(path);
}

void for_each_frame(const std::filesystem::path& path, const FrameRange& range, const TakeFrame& take) {
    client::is_publication(path) ? for_each_published(path, range, take) : for_each_recorded(path, range, take);
}

client::ReceivedFrame frame_of(const std::filesystem::path& path, std::optional<std::uint64_t> index) {
    if (!index) return client::is_publication(path) ? newest_published(path) : newest_recorded(path);
    client::ReceivedFrame found;
    for_each_frame(path, {*index, *index},
                   [&](const std::string&, const client::ReceivedFrame& frame) { found = frame; });
    return found;
}

void add_frame_option(CLI::App& command, std::optional<std::uint64_t>& index, const std::string& otherwise) {
    command
        .add_option("--frame", index,
                    "Frame of a recording or a publication, by its index (default: " + otherwise + ")")
        ->check(CLI::NonNegativeNumber);
}

}  // namespace meniscus::cli
