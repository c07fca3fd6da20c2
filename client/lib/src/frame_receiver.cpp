#include "frame_receiver.hpp"

#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "conversion/statistics_conversion.hpp"

namespace meniscus::client {

namespace {

constexpr std::uint32_t min_offset_bits = 2;
constexpr std::uint32_t max_offset_bits = 9;

void append(std::vector<std::byte>& bytes, const std::string& more) {
    const std::size_t size = bytes.size();
    bytes.resize(size + more.size());
    if (!more.empty()) std::memcpy(bytes.data() + size, more.data(), more.size());
}

std::string place_name(const std::array<std::int32_t, 3>& place) {
    std::string name = "(";
    name += std::to_string(place[0]) + ", " + std::to_string(place[1]) + ", " + std::to_string(place[2]) + ")";
    return name;
}

}  // namespace

void FrameReceiver::end_of_stream() const {
    if (frame_) throw ServerError("the server ended within frame " + std::to_string(frame_->index));
}

void FrameReceiver::begin(const v1::MeshBegin& message) {
    const std::string name = "frame " + std::to_string(message.frame_index());
    if (!meshes_) throw ServerError("the server sent a mesh that was not asked for, " + name);
    if (frame_) throw ServerError("the server began " + name + " within frame " + std::to_string(frame_->index));
    if (message.brick_cells() != static_cast<std::uint32_t>(brick_cells))
        throw ServerError(name + " has bricks of " + std::to_string(message.brick_cells()) + " cells; this version knows " +
                          std::to_string(brick_cells));
    if (message.offset_bits() < min_offset_bits || message.offset_bits() > max_offset_bits)
        throw ServerError(name + " has offset_bits " + std::to_string(message.offset_bits()) + "; allowed are 2 to 9");
    if (!std::isfinite(message.cell_size()) || message.cell_size() <= 0.0)
        throw ServerError(name + " has cell_size " + std::to_string(message.cell_size()));
    frame_.emplace();
    frame_->index = message.frame_index();
    frame_->simulation_time = message.simulation_time();
    frame_->cell_size = message.cell_size();
    frame_->offset_bits = message.offset_bits();
    brick_count_ = message.brick_count();
    missing_parts_ = 0;
    triangles_ = 0;
    places_.clear();
}

void FrameReceiver::add(const v1::MeshBrick& message) {
    if (!frame_) throw ServerError("the server sent a brick outside of a frame");
    const std::array<std::int32_t, 3> place{message.x(), message.y(), message.z()};
    const std::string name = "frame " + std::to_string(frame_->index) + ", brick " + place_name(place);
    if (missing_parts_ == 0) {
        if (message.part_index() != 0 || message.part_count() == 0)
            throw ServerError(name + " begins with part " + std::to_string(message.part_index()) + " of " +
                              std::to_string(message.part_count()));
        if (frame_->bricks.size() == brick_count_)
            throw ServerError(name + " is one more than the " + std::to_string(brick_count_) + " that were announced");
        if (!places_.insert(place).second) throw ServerError(name + " came twice");
        EncodedBrick& brick = frame_->bricks.emplace_back();
        brick.coordinate = place;
        brick.vertices = message.vertex_count();
        brick.triangles = message.triangle_count();
        append(brick.cell_levels, message.cell_levels());
        part_count_ = missing_parts_ = message.part_count();
        triangles_ += brick.triangles;
    } else if (place != frame_->bricks.back().coordinate || message.part_count() != part_count_ ||
               message.part_index() != part_count_ - missing_parts_) {
        throw ServerError(name + ", part " + std::to_string(message.part_index()) + ", came in place of part " +
                          std::to_string(part_count_ - missing_parts_) + " of brick " +
                          place_name(frame_->bricks.back().coordinate));
    }
    append(frame_->bricks.back().draco, message.draco());
    --missing_parts_;
}

ReceivedFrame FrameReceiver::end(const v1::FrameStatistics& message) {
    const std::string name = "frame " + std::to_string(message.frame_index());
    if (meshes_) {
        if (!frame_ || frame_->index != message.frame_index())
            throw ServerError("the server sent statistics of " + name + " without its mesh");
        if (missing_parts_ != 0 || frame_->bricks.size() != brick_count_)
            throw ServerError(name + " ended after " + std::to_string(frame_->bricks.size()) + " bricks of " +
                              std::to_string(brick_count_) + (missing_parts_ != 0 ? ", in the middle of one" : ""));
        if (triangles_ != message.triangles())
            throw ServerError(name + " has bricks of " + std::to_string(triangles_) + " triangles; its statistics say " +
                              std::to_string(message.triangles()));
    } else {
        frame_.emplace();
        frame_->index = message.frame_index();
        frame_->simulation_time = message.simulation_time();
    }
    ReceivedFrame frame = std::move(*frame_);
    frame_.reset();
    static_cast<Statistics&>(frame.statistics) = conversion::from_wire(message);
    frame.statistics.encode_seconds = message.encode_seconds();
    frame.statistics.latency_seconds = message.latency_seconds();
    frame.statistics.encoded_bytes = message.encoded_bytes();
    return frame;
}

}  // namespace meniscus::client
