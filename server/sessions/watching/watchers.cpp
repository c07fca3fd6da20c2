#include "sessions/watching/watchers.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace meniscus::server {

namespace {

/// Whether it is a watcher's, not a snapshot's.
bool is_watcher(const std::shared_ptr<Watch>& watch) {
    return !watch->options().once;
}

}  // namespace

bool Watchers::add(const std::shared_ptr<Watch>& watch) {
    const std::lock_guard lock(mutex_);
    if (watch->options().once) {
        const auto found = meshes_.find(watch->options().format);
        if (found == meshes_.end())
            watches_.push_back(watch);
        else
            watch->put(found->second);
        return found != meshes_.end();
    }
    watches_.push_back(watch);
    if (!watch->options().wants_meshes()) {
        const auto stride = stride_of(*watch);
        const auto found = stride ? particles_.find(*stride) : particles_.end();
        if (found == particles_.end()) return false;
        watch->put(found->second);
        return true;
    }
    const auto found = meshes_.find(watch->options().format);
    if (found == meshes_.end()) return false;
    watch->put(found->second);
    return true;
}

void Watchers::remove(const std::shared_ptr<Watch>& watch) {
    // Destroyed outside of the lock.
    Encodings::node_type mesh;
    decltype(particles_)::node_type particles;
    const std::lock_guard lock(mutex_);
    if (std::erase(watches_, watch) != 0) skipped_by_the_gone_ += watch->progress().frames_skipped;
    const MeshFormat& format = watch->options().format;
    if (!keeps(format)) mesh = meshes_.extract(format);
    if (const auto stride = stride_of(*watch); stride && !want_stride(*stride)) particles = particles_.extract(*stride);
}

std::size_t Watchers::count() const {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(std::ranges::count_if(watches_, is_watcher));
}

std::vector<std::shared_ptr<Watch>> Watchers::list() const {
    const std::lock_guard lock(mutex_);
    return watches_;
}

Watchers::Progress Watchers::progress() const {
    const std::lock_guard lock(mutex_);
    Progress sum{.frames_skipped = skipped_by_the_gone_};
    for (const auto& watch : watches_) {
        if (!is_watcher(watch)) continue;
        ++sum.watchers;
        const Watch::Progress progress = watch->progress();
        sum.frames_skipped += progress.frames_skipped;
        sum.lag = std::max(sum.lag, progress.lag);
    }
    return sum;
}

std::optional<std::uint64_t> Watchers::stride_of(const Watch& watch) const {
    if (watch.options().wants_meshes() || !particle_count_) return std::nullopt;
    return stride_for(*particle_count_, *watch.options().max_particles);
}

bool Watchers::want(const MeshFormat& format) const {
    return std::ranges::any_of(watches_, [&](const auto& watch) { return watch->options().wants(format); });
}

bool Watchers::keeps(const MeshFormat& format) const {
    return kept_.contains(format) || of_snapshot_ == format || want(format);
}

bool Watchers::want_stride(std::uint64_t stride) const {
    return std::ranges::any_of(watches_, [&](const auto& watch) { return stride_of(*watch) == stride; });
}

void Watchers::forget_particles(std::uint64_t particle_count) {
    decltype(particles_) before;  // destroyed outside of the lock
    const std::lock_guard lock(mutex_);
    particles_.swap(before);
    particle_count_ = particle_count;
}

std::set<std::uint64_t> Watchers::unpublished_strides() const {
    std::set<std::uint64_t> strides;
    const std::lock_guard lock(mutex_);
    for (const auto& watch : watches_)
        if (const auto stride = stride_of(*watch); stride && !particles_.contains(*stride)) strides.insert(*stride);
    return strides;
}

void Watchers::publish(std::uint64_t stride, const std::shared_ptr<const ParticleMessages>& particles) {
    std::vector<std::shared_ptr<Watch>> watches;
    {
        const std::lock_guard lock(mutex_);
        if (want_stride(stride)) particles_[stride] = particles;
        std::ranges::copy_if(watches_, std::back_inserter(watches),
                             [&](const auto& watch) { return stride_of(*watch) == stride; });
    }
    for (const auto& watch : watches) watch->put(particles);
}

Encodings Watchers::replace_meshes() {
    const std::lock_guard lock(mutex_);
    kept_.clear();
    of_snapshot_.reset();
    return std::exchange(meshes_, {});
}

bool Watchers::want_level(int max_level) const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(watches_,
                               [&](const auto& watch) { return watch->options().format.max_level == max_level; });
}

std::set<MeshFormat> Watchers::unpublished_formats() const {
    std::set<MeshFormat> formats;
    const std::lock_guard lock(mutex_);
    for (const auto& watch : watches_) {
        const MeshFormat& format = watch->options().format;
        if (watch->options().wants(format) && !meshes_.contains(format)) formats.insert(format);
    }
    return formats;
}

std::optional<MeshFormat> Watchers::next_unpublished_format(const std::function<bool(int max_level)>& is_there) {
    const std::lock_guard lock(mutex_);
    const auto next = std::ranges::find_if(watches_, [&](const auto& watch) {
        const MeshFormat& format = watch->options().format;
        return watch->options().wants_meshes() && !meshes_.contains(format) && is_there(format.max_level);
    });
    if (next == watches_.end()) return std::nullopt;
    const MeshFormat format = (*next)->options().format;
    std::stable_partition(watches_.begin(), watches_.end(),
                          [&](const auto& watch) { return !watch->options().wants(format); });
    return format;
}

void Watchers::publish(const MeshFormat& format, const std::shared_ptr<const EncodedFrame>& frame, Keep keep) {
    std::vector<std::shared_ptr<Watch>> watches;
    Encodings::node_type of_other_snapshot;  // destroyed outside of the lock
    {
        const std::lock_guard lock(mutex_);
        if (keep == Keep::until_the_next_frame) kept_.insert(format);
        std::ranges::copy_if(watches_, std::back_inserter(watches),
                             [&](const auto& watch) { return watch->options().wants(format); });
        if (!std::ranges::all_of(watches, is_watcher)) {
            const auto other = std::exchange(of_snapshot_, format);
            if (other && !keeps(*other)) of_other_snapshot = meshes_.extract(*other);
        }
        if (!keeps(format)) return;
        meshes_[format] = frame;
        std::erase_if(watches_,
                      [&](const auto& watch) { return !is_watcher(watch) && watch->options().wants(format); });
    }
    for (const auto& watch : watches) watch->put(frame);
}

std::shared_ptr<const EncodedFrame> Watchers::published(const MeshFormat& format) const {
    const std::lock_guard lock(mutex_);
    const auto found = meshes_.find(format);
    return found != meshes_.end() ? found->second : nullptr;
}

}  // namespace meniscus::server
