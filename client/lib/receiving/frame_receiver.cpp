#include "receiving/frame_receiver.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "conversion/attribute_conversion.hpp"
#include "conversion/brick_conversion.hpp"
#include "conversion/spray_conversion.hpp"
#include "meniscus/error.hpp"
#include "receiving/announced_attribute.hpp"
#include "receiving/frame_statistics.hpp"

namespace meniscus::client {

namespace {

/// The name of a place: of a message that has x, y and z.
template <class Message>
std::string place_name(const Message& place) {
    std::string name = "(";
    name += std::to_string(place.x()) + ", " + std::to_string(place.y()) + ", " + std::to_string(place.z()) + ")";
    return name;
}

Codec codec_of(const v1::MeshBrick& message, const std::string& name) {
    if (const auto codec = codec_by_number(static_cast<std::uint32_t>(message.codec()))) return *codec;
    throw ServerError(name + " has the codec " + std::to_string(static_cast<int>(message.codec())) +
                      ", which this version does not know; it knows " + known_codecs());
}

std::string frame_name(std::uint64_t index) {
    return "frame " + std::to_string(index);
}

void take_attributes(const v1::MeshBegin& message, ReceivedFrame& frame) {
    try {
        frame.coded_attributes = conversion::coded_attributes(message);
    } catch (const InvalidInput& error) {
        throw ServerError(frame_name(message.frame_index()) + ": " + error.what());
    }
    for (const v1::MeshAttribute& wire : message.attributes()) frame.attributes.push_back(announced_attribute(wire));
}

}  // namespace

void FrameReceiver::end_of_stream() const {
    if (frame_) throw ServerError("the server ended within " + frame_name(frame_->header.index));
}

void FrameReceiver::begin(const v1::MeshBegin& message) {
    const std::string name = frame_name(message.frame_index());
    if (!meshes_) throw ServerError("the server sent a mesh that was not asked for, " + name);
    if (frame_ && !differences_)
        throw ServerError("the server began " + name + " within " + frame_name(frame_->header.index));
    if (message.brick_cells() != static_cast<std::uint32_t>(brick_cells))
        throw ServerError(name + " has bricks of " + std::to_string(message.brick_cells()) +
                          " cells; this version knows " + std::to_string(brick_cells));
    if (message.offset_bits() < min_offset_bits || message.offset_bits() > max_offset_bits)
        throw ServerError(name + " has offset_bits " + std::to_string(message.offset_bits()) + "; allowed are " +
                          std::to_string(min_offset_bits) + " to " + std::to_string(max_offset_bits));
    if (!std::isfinite(message.cell_size()) || message.cell_size() <= 0.0)
        throw ServerError(name + " has cell_size " + std::to_string(message.cell_size()));
    Frame frame;
    frame.header.index = message.frame_index();
    frame.header.run_id = message.run_id();
    frame.header.simulation_time = message.simulation_time();
    frame.header.cell_size = message.cell_size();
    frame.header.offset_bits = message.offset_bits();
    frame.brick_count = message.brick_count();
    frame.spray_count = message.spray_count();
    frame.triangles = message.triangle_count();
    take_attributes(message, frame.header);
    begin_difference(message, frame);
    frame_ = std::move(frame);
}

void FrameReceiver::begin_difference(const v1::MeshBegin& message, Frame& frame) const {
    const std::string name = frame_name(message.frame_index());
    if (!message.has_base_frame_index()) {
        if (message.vanished_size() != 0)
            throw ServerError(name + " says that bricks have vanished, but not from which frame");
        return;
    }
    const std::string base = frame_name(message.base_frame_index());
    if (!differences_) throw ServerError(name + " is a difference to " + base + ", which was not asked for");
    if (!whole_ || whole_->index != message.base_frame_index())
        throw ServerError(name + " is a difference to " + base + "; the last complete one is " +
                          (whole_ ? frame_name(whole_->index) : "none"));
    if (whole_->cell_size != message.cell_size() || whole_->offset_bits != message.offset_bits())
        throw ServerError(name + " is a difference to " + base + ", which has another lattice");
    frame.has_base = true;
    for (const v1::BrickPlace& wire : message.vanished()) {
        const Place place{wire.z(), wire.y(), wire.x()};
        if (!bricks_.contains(place) || !frame.vanished.insert(place).second)
            throw ServerError(name + " says that brick " + place_name(wire) + " has vanished, which is not there");
    }
}

void FrameReceiver::add(const v1::MeshBrick& message) {
    if (!frame_) throw ServerError("the server sent a brick outside of a frame");
    Frame& frame = *frame_;
    const Place place{message.z(), message.y(), message.x()};
    const std::string name = frame_name(frame.header.index) + ", brick " + place_name(message);
    if (frame.missing_parts == 0) {
        if (message.part_index() != 0 || message.part_count() == 0)
            throw ServerError(name + " begins with part " + std::to_string(message.part_index()) + " of " +
                              std::to_string(message.part_count()));
        if (frame.bricks.size() == frame.brick_count)
            throw ServerError(name + " is one more than the " + std::to_string(frame.brick_count) +
                              " that were announced");
        (void)codec_of(message, name);  // refuses one that is not known
        if (frame.vanished.contains(place)) throw ServerError(name + " was said to have vanished");
        auto brick = std::make_shared<EncodedBrick>();
        if (!frame.bricks.emplace(place, brick).second) throw ServerError(name + " came twice");
        frame.brick = std::move(brick);
        frame.part_count = frame.missing_parts = message.part_count();
    } else if (frame.brick->coordinate != std::array{message.x(), message.y(), message.z()} ||
               codec_of(message, name) != frame.brick->codec || message.part_count() != frame.part_count ||
               message.part_index() != frame.part_count - frame.missing_parts) {
        throw ServerError(name + ", part " + std::to_string(message.part_index()) + ", came in place of part " +
                          std::to_string(frame.part_count - frame.missing_parts) + " of the brick before");
    }
    conversion::append_part(message, *frame.brick);
    --frame.missing_parts;
}

void FrameReceiver::add(const v1::SprayPoints& message) {
    if (!frame_) throw ServerError("the server sent spray outside of a frame");
    std::vector<Point>& spray = frame_->header.spray;
    const std::string name = frame_name(frame_->header.index);
    try {
        conversion::append_points(message, spray);
    } catch (const InvalidInput& error) {
        throw ServerError(name + ": " + error.what());
    }
    if (spray.size() > frame_->spray_count)
        throw ServerError(name + " has spray of more than the " + std::to_string(frame_->spray_count) +
                          " points that were announced");
}

void FrameReceiver::take_difference(const std::string& name, Frame& frame) {
    for (const Place& place : frame.vanished) bricks_.erase(place);
    // A brick that stays would be decoded as other values.
    if (frame.header.coded_attributes != whole_->coded_attributes)
        for (const auto& [place, brick] : bricks_)
            if (!frame.bricks.contains(place))
                throw ServerError(name +
                                  " has other attributes, or other ranges of them, than the frame before, but "
                                  "keeps a brick of it");
    for (auto& [place, brick] : frame.bricks) bricks_.insert_or_assign(place, std::move(brick));
}

void FrameReceiver::complete_mesh(const v1::FrameStatistics& message) {
    const std::string name = frame_name(message.frame_index());
    if (!frame_ || frame_->header.index != message.frame_index())
        throw ServerError("the server sent statistics of " + name + " without its mesh");
    Frame& frame = *frame_;
    if (frame.missing_parts != 0 || frame.bricks.size() != frame.brick_count)
        throw ServerError(name + " ended after " + std::to_string(frame.bricks.size()) + " bricks of " +
                          std::to_string(frame.brick_count) +
                          (frame.missing_parts != 0 ? ", in the middle of one" : ""));
    // Spray comes only where it was asked for.
    if (!frame.header.spray.empty() && frame.header.spray.size() != frame.spray_count)
        throw ServerError(name + " ended after " + std::to_string(frame.header.spray.size()) +
                          " points of spray; announced were " + std::to_string(frame.spray_count));
    if (frame.has_base)
        take_difference(name, frame);
    else
        bricks_ = std::move(frame.bricks);
    std::uint64_t triangles = 0;
    for (const auto& [place, brick] : bricks_) triangles += brick->triangles;
    if (triangles != frame.triangles)
        throw ServerError(name + " has bricks of " + std::to_string(triangles) + " triangles; announced were " +
                          std::to_string(frame.triangles));
    if (!differences_ && triangles != message.triangles())
        throw ServerError(name + " has bricks of " + std::to_string(triangles) + " triangles; its statistics say " +
                          std::to_string(message.triangles()));
    whole_ = std::move(frame.header);
    frame_.reset();
}

ReceivedFrame FrameReceiver::end(const v1::FrameStatistics& message) {
    ReceivedFrame frame;
    if (meshes_) {
        complete_mesh(message);
        frame = *whole_;
        frame.bricks.reserve(bricks_.size());
        for (const auto& [place, brick] : bricks_) frame.bricks.push_back(brick);
    } else {
        frame.index = message.frame_index();
        frame.simulation_time = message.simulation_time();
    }
    frame.statistics = frame_statistics(message);
    return frame;
}

}  // namespace meniscus::client
