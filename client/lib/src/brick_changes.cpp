#include "brick_changes.hpp"

#include <tuple>

namespace meniscus::client {

namespace {

auto order(const EncodedBrick& brick) {
    return std::tuple(brick.coordinate[2], brick.coordinate[1], brick.coordinate[0]);
}

}  // namespace

void find_changes(const std::vector<std::shared_ptr<const EncodedBrick>>& before, ReceivedFrame& frame) {
    auto old = before.begin();
    for (const auto& brick : frame.bricks) {
        for (; old != before.end() && order(**old) < order(*brick); ++old) frame.vanished.push_back((*old)->coordinate);
        const bool was_there = old != before.end() && (*old)->coordinate == brick->coordinate;
        if (!was_there || *old != brick) frame.changed.push_back(brick->coordinate);
        if (was_there) ++old;
    }
    for (; old != before.end(); ++old) frame.vanished.push_back((*old)->coordinate);
}

}  // namespace meniscus::client
