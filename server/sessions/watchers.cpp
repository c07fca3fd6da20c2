#include "sessions/watchers.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace meniscus::server {

bool Watchers::add(const std::shared_ptr<Watch>& watch) {
    const std::lock_guard lock(mutex_);
    watches_.push_back(watch);
    const WatchWishes& wishes = watch->wishes();
    if (wishes.max_particles) {
        const auto found = particles_.find(*wishes.max_particles);
        if (found == particles_.end()) return false;
        watch->put(found->second);
        return true;
    }
    const auto found = meshes_.find(wishes.format);
    if (found == meshes_.end()) return false;
    watch->put(found->second);
    return true;
}

void Watchers::remove(const std::shared_ptr<Watch>& watch) {
    const std::lock_guard lock(mutex_);
    if (std::erase(watches_, watch) != 0) skipped_by_the_gone_ += watch->progress().frames_skipped;
    const auto& wish = watch->wishes().max_particles;
    if (wish &&
        std::ranges::none_of(watches_, [&](const auto& other) { return other->wishes().max_particles == wish; }))
        particles_.erase(*wish);
}

std::size_t Watchers::count() const {
    const std::lock_guard lock(mutex_);
    return watches_.size();
}

std::vector<std::shared_ptr<Watch>> Watchers::list() const {
    const std::lock_guard lock(mutex_);
    return watches_;
}

Watchers::Progress Watchers::progress() const {
    const std::lock_guard lock(mutex_);
    Progress sum{.watchers = static_cast<std::uint32_t>(watches_.size()), .frames_skipped = skipped_by_the_gone_};
    for (const auto& watch : watches_) {
        const Watch::Progress progress = watch->progress();
        sum.frames_skipped += progress.frames_skipped;
        sum.lag = std::max(sum.lag, progress.lag);
    }
    return sum;
}

void Watchers::forget_particles() {
    decltype(particles_) before;  // destroyed outside of the lock
    const std::lock_guard lock(mutex_);
    particles_.swap(before);
}

std::optional<std::uint64_t> Watchers::unpublished_particles() const {
    const std::lock_guard lock(mutex_);
    for (const auto& watch : watches_)
        if (const auto& wish = watch->wishes().max_particles; wish && !particles_.contains(*wish)) return wish;
    return std::nullopt;
}

void Watchers::publish(std::uint64_t max_particles, const std::shared_ptr<const ParticleMessages>& particles) {
    std::vector<std::shared_ptr<Watch>> watches;
    {
        const std::lock_guard lock(mutex_);
        particles_[max_particles] = particles;
        std::ranges::copy_if(watches_, std::back_inserter(watches),
                             [&](const auto& watch) { return watch->wishes().max_particles == max_particles; });
    }
    for (const auto& watch : watches) watch->put(particles);
}

Encodings Watchers::replace_meshes() {
    const std::lock_guard lock(mutex_);
    return std::exchange(meshes_, {});
}

bool Watchers::wish_for_level(int max_level) const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(watches_,
                               [&](const auto& watch) { return watch->wishes().format.max_level == max_level; });
}

std::optional<MeshFormat> Watchers::unpublished_format(const std::function<bool(int max_level)>& is_there) const {
    const std::lock_guard lock(mutex_);
    for (const auto& watch : watches_) {
        const MeshFormat& format = watch->wishes().format;
        if (watch->wishes().wants(format) && !meshes_.contains(format) && is_there(format.max_level)) return format;
    }
    return std::nullopt;
}

void Watchers::publish(const MeshFormat& format, const std::shared_ptr<const EncodedFrame>& frame) {
    std::vector<std::shared_ptr<Watch>> watches;
    {
        const std::lock_guard lock(mutex_);
        meshes_[format] = frame;
        std::ranges::copy_if(watches_, std::back_inserter(watches),
                             [&](const auto& watch) { return watch->wishes().wants(format); });
    }
    for (const auto& watch : watches) watch->put(frame);
}

std::shared_ptr<const EncodedFrame> Watchers::published(const MeshFormat& format) const {
    const std::lock_guard lock(mutex_);
    const auto found = meshes_.find(format);
    return found != meshes_.end() ? found->second : nullptr;
}

}  // namespace meniscus::server
