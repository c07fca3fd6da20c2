// Every order of events in a small world.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace meniscus::server::test {

struct Explored {
    bool all_can_come = true;  ///< in every order: nothing breaks, and whatever waits is helped
    std::size_t states = 0;    ///< that differ; up to the first fault
};

/// Follows all orders. small: has after(path), the world once these events, a character each, have happened;
/// events_in(world, path), that may happen then; key_of(world, path), equal for worlds that go on alike; and
/// all_are_gone(world). Its worlds are `broken` once something that must not be has been.
template <class Small>
Explored explore(const Small& small) {
    std::set<std::string> seen;
    std::vector<std::string> open{""};
    while (!open.empty()) {
        const std::string path = std::move(open.back());
        open.pop_back();
        const auto world = small.after(path);
        if (!seen.insert(small.key_of(*world, path)).second) continue;
        const std::string events = small.events_in(*world, path);
        if (world->broken || (events.empty() && !small.all_are_gone(*world))) return {false, seen.size()};
        for (const char event : events) open.push_back(path + event);
    }
    return {true, seen.size()};
}

}  // namespace meniscus::server::test
