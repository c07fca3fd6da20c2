// The session's particles, for those who watch them: encoded by its first thread, once for all who wish for as many.
#include <algorithm>
#include <exception>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "log.hpp"
#include "sessions/session.hpp"

namespace meniscus::server {

void Session::show_particles(const InputFrame& input) {
    try {
        while (const auto max_particles = unpublished_particles())
            publish(*max_particles, std::make_shared<const ParticleMessages>(encode_particles(
                                        input, *input.shown_in_run, settings_.particle_radius, *max_particles)));
    } catch (const std::exception& error) {
        log_error({.session = id(), .frame = input.index}, "no particles for its watchers, who keep those before: {}",
                  error.what());
    }
}

void Session::show_particles_again() {
    InputFrame* input = take_back_newest_input();
    if (input == nullptr) return;
    if (input->shown_in_run) show_particles(*input);
    return_input(*input);
}

InputFrame* Session::take_back_newest_input() {
    if (newest_input_ == nullptr || free_inputs_.take(*newest_input_)) return newest_input_;
    // The third one is not among the free ones while no stream may use it.
    if (newest_input_ != &inputs_.back()) return nullptr;
    const std::lock_guard lock(mutex_);
    return std::exchange(third_input_in_use_, true) ? nullptr : newest_input_;
}

std::optional<std::uint64_t> Session::unpublished_particles() const {
    const std::lock_guard lock(mutex_);
    for (const auto& watch : watches_)
        if (const auto& wish = watch->wishes().max_particles; wish && !particles_.contains(*wish)) return wish;
    return std::nullopt;
}

void Session::publish(std::uint64_t max_particles, const std::shared_ptr<const ParticleMessages>& particles) {
    std::vector<std::shared_ptr<Watch>> watches;
    {
        const std::lock_guard lock(mutex_);
        particles_[max_particles] = particles;
        std::ranges::copy_if(watches_, std::back_inserter(watches),
                             [&](const auto& watch) { return watch->wishes().max_particles == max_particles; });
    }
    for (const auto& watch : watches) watch->put(particles);
}

}  // namespace meniscus::server
