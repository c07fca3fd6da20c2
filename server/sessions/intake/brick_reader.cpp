#include "sessions/intake/brick_reader.hpp"

#include <fmt/format.h>
#include <google/protobuf/io/coded_stream.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "conversion/brick_conversion.hpp"
#include "conversion/spray_conversion.hpp"
#include "meniscus/array_form.hpp"
#include "meniscus/brick_recoding.hpp"
#include "meniscus/error.hpp"
#include "meniscus/v1/surface_service.pb.h"
#include "sessions/limits/limits.hpp"
#include "sessions/sending/brick_messages.hpp"
#include "sessions/sending/place_order.hpp"

namespace meniscus::server {

namespace {

std::string place_of(const EncodedBrick& brick) {
    return fmt::format("brick ({}, {}, {})", brick.coordinate[0], brick.coordinate[1], brick.coordinate[2]);
}

/// The messages of one part, each behind its length.
class PartMessages {
public:
    explicit PartMessages(std::span<const std::byte> bytes)
        : stream_(reinterpret_cast<const std::uint8_t*>(bytes.data()), static_cast<int>(bytes.size())) {
        stream_.SetTotalBytesLimit(static_cast<int>(bytes.size()));
    }
    /// False behind the last one. Throws InvalidInput for bytes that are no message.
    bool next(v1::WatchResponse& message) {
        const int place = stream_.CurrentPosition();
        std::uint32_t length = 0;
        if (stream_.ExpectAtEnd() || stream_.BytesUntilTotalBytesLimit() == 0) return false;
        if (!stream_.ReadVarint32(&length) || length > static_cast<std::uint32_t>(stream_.BytesUntilTotalBytesLimit()))
            throw InvalidInput(fmt::format("no message at byte {}, or one that goes on behind the last", place));
        // Unknown fields take many times their bytes once they are parsed.
        constexpr std::uint32_t most = chunk_bytes + 1024;
        if (length > most)
            throw InvalidInput(
                fmt::format("the message at byte {} has {} bytes; it must have at most {}: send a brick "
                            "in parts of at most {} bytes",
                            place, length, most, chunk_bytes));
        const auto limit = stream_.PushLimit(static_cast<int>(length));
        if (!message.ParseFromCodedStream(&stream_) || !stream_.ConsumedEntireMessage())
            throw InvalidInput(fmt::format("the bytes from {} on are no message", place));
        stream_.PopLimit(limit);
        return true;
    }

private:
    google::protobuf::io::CodedInputStream stream_;
};

/// Takes the messages of one part.
class PartReading {
public:
    PartReading(const BrickPart& announced, Array<Point>& spray) : announced_(announced), spray_(spray) {}

    void take(const v1::WatchResponse& message) {
        if (message.has_mesh_brick())
            take(message.mesh_brick());
        else if (message.has_spray_points())
            take(message.spray_points());
        else
            throw InvalidInput("a message that is neither mesh_brick nor spray_points");
    }
    std::vector<EncodedBrick> end() {
        if (missing_parts_ != 0)
            throw InvalidInput(fmt::format("{} ends within its messages", place_of(bricks_.back())));
        require("bricks", bricks_.size(), announced_.bricks);
        require("points of spray", points_, announced_.spray_points);
        std::uint64_t triangles = 0;
        std::uint64_t vertices = 0;
        for (const EncodedBrick& brick : bricks_) {
            triangles += brick.triangles;
            vertices += brick.vertices;
        }
        require("triangles", triangles, announced_.triangles);
        if (announced_.statistics.vertices > vertices)
            throw InvalidInput(fmt::format("the statistics have {} vertices, and the bricks have {}",
                                           announced_.statistics.vertices, vertices));
        return std::move(bricks_);
    }

private:
    static void require(const char* what, std::uint64_t came, std::uint64_t announced) {
        if (came != announced)
            throw InvalidInput(fmt::format("{} {} came, and {} were announced", came, what, announced));
    }

    void take(const v1::MeshBrick& message) {
        if (missing_parts_ == 0) {
            if (message.part_index() != 0 || message.part_count() == 0)
                throw InvalidInput(fmt::format("brick ({}, {}, {}) begins with part {} of {}", message.x(), message.y(),
                                               message.z(), message.part_index(), message.part_count()));
            if (bricks_.size() == announced_.bricks)
                throw InvalidInput(fmt::format("more bricks than the {} that were announced", announced_.bricks));
            conversion::append_part(message, bricks_.emplace_back());
            part_count_ = missing_parts_ = message.part_count();
        } else {
            EncodedBrick& brick = bricks_.back();
            const std::uint32_t expected = part_count_ - missing_parts_;
            if (brick.coordinate != std::array{message.x(), message.y(), message.z()} ||
                message.part_count() != part_count_ || message.part_index() != expected)
                throw InvalidInput(fmt::format("brick ({}, {}, {}), part {}, came in place of part {} of {}",
                                               message.x(), message.y(), message.z(), message.part_index(), expected,
                                               place_of(brick)));
            conversion::append_part(message, brick);
        }
        --missing_parts_;
    }
    void take(const v1::SprayPoints& message) {
        if (missing_parts_ != 0 || bricks_.size() != announced_.bricks)
            throw InvalidInput("spray in front of the last brick; it comes behind all of them");
        std::vector<Point> points;
        conversion::append_points(message, points);
        points_ += points.size();
        if (points_ > announced_.spray_points)
            throw InvalidInput(
                fmt::format("more spray than the {} points that were announced", announced_.spray_points));
        spray_.insert(spray_.end(), points.begin(), points.end());
    }

    const BrickPart& announced_;
    Array<Point>& spray_;
    std::vector<EncodedBrick> bricks_;
    std::uint32_t part_count_ = 0;
    std::uint32_t missing_parts_ = 0;  ///< of the last brick
    std::uint64_t points_ = 0;
};

/// Bytes that a frame takes beside those that have come: its bricks, and their messages to watchers.
std::size_t bytes_once_parsed(const InputFrame& input) {
    constexpr std::size_t copies = 3;           // parsed, as messages, and while a message is made
    constexpr std::size_t bytes_a_brick = 640;  // what is known of it, and the records of its messages
    std::size_t bytes = copies * input.bytes.size();
    for (const BrickPart& part : input.brick_parts) bytes += bytes_a_brick * std::size_t{part.bricks};
    return bytes;
}

/// Throws InvalidInput for a brick that has not the codec and the normals of the others.
void require_same_form(const EncodedBrick& brick, const FinishedBricks& all) {
    if (brick.codec != all.codec)
        throw InvalidInput(fmt::format("{} has the codec {}, and others of the frame have {}; they have one",
                                       place_of(brick), name_of(brick.codec), name_of(all.codec)));
    if (!needs_lattice(brick.codec))
        throw InvalidInput(
            fmt::format("{} has the codec {}; publish packed or entropy, which all receivers' codecs can be "
                        "made of",
                        place_of(brick), name_of(brick.codec)));
    if (const int bits = normal_bits_of(brick); bits != all.normal_bits)
        throw InvalidInput(fmt::format("{} has normals of {} bits, and others of the frame have {}; they have the same",
                                       place_of(brick), bits, all.normal_bits));
}

/// In words.
std::string forms_of(const std::vector<CodedAttribute>& attributes) {
    std::string words;
    for (const CodedAttribute& attribute : attributes)
        words += fmt::format("{}'{}', {}", words.empty() ? "" : "; ", attribute.name,
                             form_of(attribute.type, attribute.components));
    return words.empty() ? "none" : words;
}

/// Calls work(); says of which part what it throws is, if there are several.
template <class Work>
void about_part(std::size_t part, std::size_t parts, const Work& work) {
    try {
        work();
    } catch (const InvalidInput& error) {
        if (parts == 1) throw;
        throw InvalidInput(fmt::format("part {} of {}: {}", part, parts, error.what()));
    }
}

}  // namespace

std::vector<BrickReader::Brick> BrickReader::bricks_of(const InputFrame& input, Array<Point>& spray) const {
    const std::size_t parts = input.brick_parts.size();
    std::span<const std::byte> bytes(input.bytes);
    std::vector<Brick> bricks;
    v1::WatchResponse message;
    for (std::size_t p = 0; p < parts; ++p)
        about_part(p, parts, [&] {
            PartMessages messages(bytes.first(input.brick_parts[p].bytes));
            PartReading reading(input.brick_parts[p], spray);
            while (messages.next(message)) {
                stop_if_asked();
                reading.take(message);
            }
            for (EncodedBrick& brick : reading.end())
                bricks.push_back({.encoded = std::move(brick), .part = static_cast<std::uint32_t>(p)});
            bytes = bytes.subspan(input.brick_parts[p].bytes);
        });
    std::ranges::sort(bricks, {}, [](const Brick& brick) { return PlaceOrder(brick.encoded.coordinate); });
    const auto twice =
        std::ranges::adjacent_find(bricks, {}, [](const Brick& brick) { return PlaceOrder(brick.encoded.coordinate); });
    if (twice != bricks.end())
        throw InvalidInput(parts == 1 ? fmt::format("{} comes twice", place_of(twice->encoded))
                                      : fmt::format("{} comes from part {} and from part {}; each brick has one owner",
                                                    place_of(twice->encoded), std::min(twice->part, twice[1].part),
                                                    std::max(twice->part, twice[1].part)));
    return bricks;
}

void BrickReader::stop_if_asked() const {
    if (stop_ && stop_->is_raised()) throw Stopped();
}

void BrickReader::require_in_domain(const EncodedBrick& brick) const {
    if (!settings_.domain) return;
    const double cell = world_cell_size(settings_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double low = brick.coordinate[axis] * (brick_cells * cell);
        // The domain is rounded outward to whole cells.
        if (low > settings_.domain->max[axis] + cell || low + brick_cells * cell < settings_.domain->min[axis] - cell)
            throw InvalidInput(fmt::format("{} lies outside of the session's domain", place_of(brick)));
    }
}

std::vector<CodedAttribute> BrickReader::attributes_of(std::span<const BrickPart> parts) const {
    const BrickPart& lead = lead_of(parts);
    if (attributes_.empty()) return lead.attributes;
    if (lead.attributes.empty() && lead.bricks == 0) return attributes_;
    const auto have_same_form = [](const CodedAttribute& a, const CodedAttribute& b) {
        return a.name == b.name && a.type == b.type && a.components == b.components;
    };
    if (!std::ranges::equal(lead.attributes, attributes_, have_same_form))
        throw InvalidInput(fmt::format("the attributes are {}, must be as in the frames before: {}",
                                       forms_of(lead.attributes), forms_of(attributes_)));
    return lead.attributes;
}

BrickReader::Known BrickReader::checked(const Brick& brick, const std::vector<CodedAttribute>& attributes,
                                        const Known* before) {
    stop_if_asked();
    const ContentHash hash = content_hash(brick.encoded, attributes);
    if (before != nullptr && before->messages->content_hash == hash) return *before;
    if (brick.encoded.triangles == 0) throw InvalidInput(fmt::format("{} has no triangles", place_of(brick.encoded)));
    require_in_domain(brick.encoded);
    Known known;
    {
        ScratchPool::Loan loan(scratch_);
        const DecodedBrick decoded = decode_brick(brick.encoded, offset_bits(settings_), attributes, *loan);
        if (check_ == Check::closed_surface)
            known.open = std::make_shared<const OpenEdges>(open_edges(decoded, scratch_.account()));
    }
    known.messages = brick_messages(brick.encoded, hash);
    return known;
}

void BrickReader::read(const InputFrame& input, ReconstructedFrame& frame) {
    const std::span<const BrickPart> parts(input.brick_parts);
    const std::vector<CodedAttribute> attributes = attributes_of(parts);
    Mesh& mesh = frame.mesh;
    mesh = {};
    mesh.cell_size = world_cell_size(settings_);
    mesh.offset_bits = offset_bits(settings_);
    for (const CodedAttribute& form : attributes)
        mesh.attributes.push_back({form.name, form.type, form.components, {}});
    auto finished = std::make_shared<FinishedBricks>();
    finished->charge = std::make_shared<const MemoryCharge>(scratch_.account(), bytes_once_parsed(input));
    const std::vector<Brick> bricks = bricks_of(input, mesh.spray);
    finished->offset_bits = mesh.offset_bits;
    finished->attributes = attributes;
    if (!bricks.empty()) {
        finished->codec = bricks.front().encoded.codec;
        if (needs_lattice(finished->codec)) finished->normal_bits = normal_bits_of(bricks.front().encoded);
        if (settings_.normals != (finished->normal_bits != 0) && needs_lattice(finished->codec))
            throw InvalidInput(fmt::format("the bricks have normals of {} bits, and the session's settings ask for {}",
                                           finished->normal_bits, settings_.normals ? "normals: 2 to 16" : "none"));
    }
    for (const Brick& brick : bricks)
        about_part(brick.part, parts.size(), [&] {
            require_same_form(brick.encoded, *finished);
            finished->triangles += brick.encoded.triangles;
        });

    std::vector<Known> known(bricks.size());
    workers_->for_each(bricks.size(), [&](std::size_t i) {
        about_part(bricks[i].part, parts.size(), [&] {
            const PlaceOrder place(bricks[i].encoded.coordinate);
            const auto before = std::ranges::lower_bound(
                known_, place, {}, [](const Known& brick) { return PlaceOrder(brick.messages->place); });
            const bool was_there = before != known_.end() && PlaceOrder(before->messages->place) == place;
            known[i] = checked(bricks[i], attributes, was_there ? &*before : nullptr);
        });
    });
    for (const Known& brick : known) finished->bricks.push_back(brick.messages);
    if (check_ == Check::closed_surface) {
        std::vector<std::shared_ptr<const OpenEdges>> open;
        open.reserve(known.size());
        for (const Known& brick : known) open.push_back(brick.open);
        require_closed(open, mesh, scratch_.account());
    }
    known_ = std::move(known);
    attributes_ = finished->attributes;
    frame.finished = std::move(finished);
    frame.statistics = joint_statistics(parts);
    frame.ranges = {};
    frame.ranges.back() = joint_ranges(parts);
}

}  // namespace meniscus::server
