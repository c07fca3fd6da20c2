#include "sessions/session/shown_particles.hpp"

#include <exception>
#include <utility>

#include "process/log.hpp"
#include "sessions/watching/particle_messages.hpp"

namespace meniscus::server {

ShownParticles::ShownParticles(std::string session, double particle_radius, InputSlots& inputs, Watchers& watchers,
                               SessionObservers observers)
    : session_(std::move(session)),
      particle_radius_(particle_radius),
      inputs_(inputs),
      watchers_(watchers),
      observers_(std::move(observers)) {}

bool ShownParticles::show(InputFrame& input, Run& run) {
    if (run.last_shown && input.index <= *run.last_shown) return false;
    run.last_shown = input.index;
    for (const auto& observer : observers_) observer->reconstructed(input);
    input.shown_in_run = run.id;
    if (newest_ == &kept_) kept_.free_memory();
    newest_ = &input;
    watchers_.forget_particles(input.particle_count);
    return true;
}

void ShownParticles::show_again() {
    if (watchers_.unpublished_strides().empty()) return;
    if (kept() != nullptr) return encode(kept_);
    if (newest_ == nullptr || !inputs_.take_back(*newest_)) return;
    if (newest_->shown_in_run) encode(*newest_);
    inputs_.give_back(*newest_);
}

bool ShownParticles::keep() {
    if (kept() != nullptr) return true;
    if (newest_ == nullptr || !inputs_.take_back(*newest_)) return false;
    InputFrame& slot = *newest_;
    if (slot.shown_in_run) {
        kept_.take_from(slot);
        newest_ = &kept_;
    }
    inputs_.give_back(slot);
    return kept() != nullptr;
}

void ShownParticles::encode(const InputFrame& input) {
    try {
        // Each stride once: a watcher that comes meanwhile has left a note behind the frames.
        for (const std::uint64_t stride : watchers_.unpublished_strides())
            watchers_.publish(stride, std::make_shared<const ParticleMessages>(
                                          encode_particles(input, *input.shown_in_run, particle_radius_, stride)));
    } catch (const std::exception& error) {
        log_error({.session = session_, .frame = input.index},
                  "no particles for its watchers, who keep those before: {}", error.what());
    }
}

}  // namespace meniscus::server
