#include "sessions/limits/snapshot_places.hpp"

#include <fmt/format.h>

#include <atomic>
#include <utility>

#include "sessions/limits/limit_reached.hpp"

namespace meniscus::server {

namespace {

/// One more of the count, until it is destroyed. owner: whose member the count is.
template <class Owner>
std::shared_ptr<void> one_of(std::atomic<std::uint32_t>& count, std::shared_ptr<Owner> owner) {
    return {&count, [owner = std::move(owner)](void* taken) { --*static_cast<std::atomic<std::uint32_t>*>(taken); }};
}

}  // namespace

SnapshotPlaces::SnapshotPlaces(std::uint32_t all, std::uint32_t of_one_name)
    : limit_(all), limit_of_name_(of_one_name) {}

SnapshotPlaces::Place SnapshotPlaces::take(const std::shared_ptr<NameAccount>& caller) {
    const std::uint32_t others = (*taken_)++;
    auto place = one_of(*taken_, taken_);
    if (limit_ != 0 && others >= limit_)
        throw LimitReached(LimitName::snapshots, fmt::format("{} snapshots are under way; the server takes at most {} "
                                                             "at a time: try again later",
                                                             others, limit_));
    if (!caller) return place;
    const std::uint32_t others_of_name = caller->snapshots++;
    auto place_of_name = one_of(caller->snapshots, caller);
    if (limit_of_name_ != 0 && others_of_name >= limit_of_name_)
        throw LimitReached(LimitName::snapshots_per_name,
                           fmt::format("{} snapshots of {} are under way; the server takes at most {} of one caller at "
                                       "a time: try again later",
                                       others_of_name, caller->name(), limit_of_name_));
    return std::make_shared<std::pair<Place, Place>>(std::move(place), std::move(place_of_name));
}

}  // namespace meniscus::server
