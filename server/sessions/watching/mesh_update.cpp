#include "sessions/watching/mesh_update.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <memory>
#include <span>
#include <utility>

#include "meniscus/mesh.hpp"
#include "sessions/sending/begin_message.hpp"
#include "sessions/sending/place_order.hpp"

namespace meniscus::server {

namespace {

/// World units; closed.
Box box_of(const BrickMessages& brick, double cell_size) {
    const double edge = brick_cells * cell_size;
    Box box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.min[axis] = edge * brick.place[axis];
        box.max[axis] = edge * (brick.place[axis] + 1.0);
    }
    return box;
}

bool touch(const Box& a, const Box& b) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (a.max[axis] < b.min[axis] || b.max[axis] < a.min[axis]) return false;
    return true;
}

double squared_distance(const Box& box, const std::array<double, 3>& point) {
    double sum = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double d = point[axis] - std::clamp(point[axis], box.min[axis], box.max[axis]);
        sum += d * d;
    }
    return sum;
}

/// The best first, for a viewer that shows the mesh while it arrives.
void order(std::vector<const BrickMessages*>& bricks, const WatchOptions& options, double cell_size) {
    if (!options.viewpoint) {
        std::ranges::stable_sort(bricks, std::ranges::greater(), &BrickMessages::triangles);
        return;
    }
    std::vector<std::pair<double, const BrickMessages*>> distances;
    distances.reserve(bricks.size());
    for (const BrickMessages* brick : bricks)
        distances.emplace_back(squared_distance(box_of(*brick, cell_size), *options.viewpoint), brick);
    std::ranges::stable_sort(distances, {}, [](const auto& entry) { return entry.first; });
    std::ranges::transform(distances, bricks.begin(), [](const auto& entry) { return entry.second; });
}

/// A new mesh against the one that the watcher has.
struct Difference {
    std::vector<const BrickMessages*> changed;
    std::vector<std::array<std::int32_t, 3>> vanished;
};

Difference compare(std::span<const SharedBrick> bricks, std::span<const WatcherMesh::Brick> base) {
    Difference difference;
    auto old = base.begin();
    const auto vanish_before = [&](const auto& is_before) {
        for (; old != base.end() && is_before(PlaceOrder(old->place)); ++old) difference.vanished.push_back(old->place);
    };
    for (const SharedBrick& brick : bricks) {
        const PlaceOrder place(brick->place);
        vanish_before([&](const PlaceOrder& p) { return p < place; });
        const bool was_there = old != base.end() && old->place == brick->place;
        if (!was_there || old->content_hash != brick->content_hash) difference.changed.push_back(brick.get());
        if (was_there) ++old;
    }
    vanish_before([](const PlaceOrder&) { return true; });
    return difference;
}

SharedMessage begin_message(const EncodedFrame& frame, const Difference& difference, std::uint64_t triangles,
                            const WatcherMesh* base) {
    v1::StreamResponse response = begin_response(frame);
    v1::MeshBegin& begin = *response.mutable_mesh_begin();
    begin.set_brick_count(static_cast<std::uint32_t>(difference.changed.size()));
    begin.set_triangle_count(triangles);
    if (base != nullptr) {
        begin.set_base_frame_index(base->frame_index);
        for (const auto& place : difference.vanished) {
            v1::BrickPlace& wire = *begin.add_vanished();
            wire.set_x(place[0]);
            wire.set_y(place[1]);
            wire.set_z(place[2]);
        }
    }
    return std::make_shared<const std::string>(response.SerializeAsString());
}

}  // namespace

FrameUpdate update_mesh(const EncodedFrame& frame, const WatchOptions& options, const WatcherMesh* base) {
    std::vector<SharedBrick> inside;
    std::span<const SharedBrick> bricks = frame.bricks;
    if (options.region) {
        std::ranges::copy_if(frame.bricks, std::back_inserter(inside), [&](const SharedBrick& brick) {
            return touch(box_of(*brick, frame.cell_size), *options.region);
        });
        bricks = inside;
    }

    Difference difference = compare(bricks, base != nullptr ? base->bricks : std::span<const WatcherMesh::Brick>());
    if (difference.vanished.size() > max_vanished) {
        base = nullptr;
        difference = compare(bricks, {});
    }
    order(difference.changed, options, frame.cell_size);

    FrameUpdate update;
    std::uint64_t triangles = 0;
    update.result.frame_index = frame.index;
    update.result.bricks.reserve(bricks.size());
    for (const SharedBrick& brick : bricks) {
        update.result.bricks.push_back({.place = brick->place, .content_hash = brick->content_hash});
        triangles += brick->triangles;
    }
    update.messages.push_back(begin_message(frame, difference, triangles, base));
    for (const BrickMessages* brick : difference.changed)
        update.messages.insert(update.messages.end(), brick->messages.begin(), brick->messages.end());
    if (options.spray) update.messages.insert(update.messages.end(), frame.spray.begin(), frame.spray.end());
    update.messages.push_back(frame.end);
    for (const SharedMessage& message : update.messages) update.bytes += message->size();
    return update;
}

}  // namespace meniscus::server
