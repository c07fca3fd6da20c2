#include "publications/manifest.hpp"

#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "conversion/attribute_conversion.hpp"
#include "conversion/settings_conversion.hpp"
#include "description/label.hpp"
#include "files/publication_format.hpp"
#include "files/segment_file.hpp"
#include "meniscus/error.hpp"
#include "meniscus/quoted.hpp"
#include "meniscus/v1/publication.pb.h"
#include "receiving/announced_attribute.hpp"
#include "receiving/session_description.hpp"

namespace meniscus::client {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
    throw InvalidInput(name + ": " + what);
}

/// Of protobuf's reason, whose other lines quote the text.
constexpr std::size_t shown_of_reason = 200;

std::string first_line(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

void write(const PublishedSegment& segment, v1::PublishedSegment& wire) {
    wire.set_sha256(segment.sha256);
    wire.set_bytes(static_cast<std::uint32_t>(segment.bytes));
    wire.set_frames(static_cast<std::uint32_t>(segment.frames));
    wire.set_seconds(segment.seconds);
    wire.set_first_frame(segment.first_frame);
    wire.set_last_frame(segment.last_frame);
    wire.set_first_time(segment.first_time);
    wire.set_last_time(segment.last_time);
    wire.set_run_id(segment.run_id);
}

bool is_sha256(const std::string& text) {
    return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

PublishedSegment read(const v1::PublishedSegment& wire, const std::string& name) {
    if (!is_sha256(wire.sha256()))
        refuse(name, "its SHA-256 is " + quoted(wire.sha256()) + "; it has 64 hexadecimal digits in lower case");
    if (wire.bytes() == 0 || wire.bytes() > files::max_segment_bytes)
        refuse(name, "it has " + std::to_string(wire.bytes()) + " bytes; 1 to " +
                         std::to_string(files::max_segment_bytes) + " are possible");
    if (wire.frames() == 0 || wire.frames() > wire.bytes())
        refuse(name, "it has " + std::to_string(wire.frames()) + " frames in " + std::to_string(wire.bytes()) +
                         " bytes; there are 1 to as many as bytes");
    if (!std::isfinite(wire.seconds()) || wire.seconds() < 0.0)
        refuse(name, "it is shown for " + std::to_string(wire.seconds()) + " s; 0 or more are possible");
    if (wire.last_frame() < wire.first_frame() || wire.last_frame() - wire.first_frame() < wire.frames() - 1)
        refuse(name, "it has " + std::to_string(wire.frames()) + " frames from " + std::to_string(wire.first_frame()) +
                         " to " + std::to_string(wire.last_frame()) + "; indices rise");
    if (!std::isfinite(wire.first_time()) || !std::isfinite(wire.last_time()))
        refuse(name, "its simulation times are not finite");
    return {.sha256 = wire.sha256(),
            .bytes = wire.bytes(),
            .frames = wire.frames(),
            .seconds = wire.seconds(),
            .first_frame = wire.first_frame(),
            .last_frame = wire.last_frame(),
            .first_time = wire.first_time(),
            .last_time = wire.last_time(),
            .run_id = wire.run_id()};
}

/// The settings of a later version may have fields that this one does not know.
std::optional<Settings> settings_of(const v1::Settings& wire) {
    try {
        Settings settings = conversion::from_wire(wire);
        validate(settings);
        return settings;
    } catch (const InvalidInput&) {
        return std::nullopt;
    }
}

SessionDescription description_of(const v1::SessionDescription& wire) {
    try {
        description::require_name(wire.name());
        description::require_length_unit(wire.length_unit());
        return from_wire(wire);
    } catch (const InvalidInput&) {
        return {};
    }
}

std::vector<FrameAttribute> attributes_of(const v1::Publication& wire, const std::string& name) {
    v1::MeshBegin begin;  // its rules hold for these, too
    *begin.mutable_attributes() = wire.attributes();
    try {
        (void)conversion::coded_attributes(begin);
    } catch (const InvalidInput& error) {
        refuse(name, error.what());
    }
    std::vector<FrameAttribute> attributes;
    for (const v1::MeshAttribute& attribute : wire.attributes()) attributes.push_back(announced_attribute(attribute));
    return attributes;
}

void take_segments(const v1::Publication& wire, const std::string& name, PublicationInfo& info) {
    info.left_frames = wire.left_frames();
    for (const v1::PublishedSegment& segment : wire.segments()) {
        info.segments.push_back(read(segment, name + ": segment " + std::to_string(info.segments.size() + 1)));
        info.frames += info.segments.back().frames;
        info.bytes += info.segments.back().bytes;
    }
    if (info.frames > std::numeric_limits<std::uint64_t>::max() - info.left_frames)
        refuse(name, std::to_string(info.left_frames) + " frames have left; so many cannot be numbered");
    if (wire.frames() != info.frames || wire.bytes() != info.bytes)
        refuse(name, "it says " + std::to_string(wire.frames()) + " frames of " + std::to_string(wire.bytes()) +
                         " bytes; its segments have " + std::to_string(info.frames) + " of " +
                         std::to_string(info.bytes));
}

}  // namespace

std::string manifest_text(const PublicationInfo& info) {
    v1::Publication wire;
    *wire.mutable_description() = to_wire(info.description);
    if (info.settings) *wire.mutable_settings() = conversion::to_wire(*info.settings);
    v1::MeshBegin begin;
    for (const FrameAttribute& attribute : info.attributes)
        conversion::announce({attribute.name, attribute.type, attribute.components, {}},
                             attribute.range ? &*attribute.range : nullptr, nullptr, begin);
    *wire.mutable_attributes() = begin.attributes();
    wire.set_normals_by_receiver(info.normals_by == NormalsBy::receiver);
    wire.set_live(info.live);
    wire.set_left_frames(info.left_frames);
    wire.set_frames(info.frames);
    wire.set_bytes(info.bytes);
    for (const PublishedSegment& segment : info.segments) write(segment, *wire.add_segments());
    return files::manifest_json(std::move(wire));
}

PublicationInfo read_manifest(const std::string& name, std::string_view text) {
    if (text.size() > files::max_manifest_bytes)
        refuse(name, std::to_string(text.size()) + " bytes; a manifest has at most " +
                         std::to_string(files::max_manifest_bytes));
    google::protobuf::util::JsonParseOptions options;
    options.ignore_unknown_fields = true;
    v1::Publication wire;
    const auto status = google::protobuf::util::JsonStringToMessage(
        google::protobuf::StringPiece(text.data(), text.size()), &wire, options);
    if (!status.ok())
        refuse(name, "not a manifest: " + escaped(first_line(status.message().ToString()), shown_of_reason));
    if (wire.format() != files::publication_format)
        refuse(name, "not the manifest of a publication: its format is " + quoted(wire.format()) + ", not \"" +
                         std::string(files::publication_format) + "\"");
    if (wire.version() != files::publication_version)
        refuse(name, "a publication of format version " + std::to_string(wire.version()) +
                         "; this program reads version " + std::to_string(files::publication_version) +
                         ": read it with the Meniscus that wrote it");
    PublicationInfo info;
    info.description = description_of(wire.description());
    info.settings = settings_of(wire.settings());
    info.attributes = attributes_of(wire, name);
    info.normals_by = wire.normals_by_receiver() ? NormalsBy::receiver : NormalsBy::server;
    info.live = wire.live();
    take_segments(wire, name, info);
    return info;
}

}  // namespace meniscus::client
