#include "simulator/simulation.hpp"

#include <algorithm>
#include <cmath>

namespace meniscus::simulator {
namespace {

SolverSettings solver_settings(const Scene& scene) {
    SolverSettings settings;
    settings.particle_radius = scene.particle_radius;
    return settings;
}

/// A disc of particles at rest distance.
std::vector<Vector3> disc(const Nozzle& nozzle, float particle_radius) {
    std::vector<Vector3> out;
    const float distance = 2.0F * particle_radius;
    const int reach = static_cast<int>(nozzle.radius / distance);
    for (int i = -reach; i <= reach; ++i)
        for (int k = -reach; k <= reach; ++k) {
            const float x = static_cast<float>(i) * distance;
            const float z = static_cast<float>(k) * distance;
            if (x * x + z * z <= nozzle.radius * nozzle.radius)
                out.push_back({nozzle.center[0] + x, nozzle.center[1], nozzle.center[2] + z});
        }
    return out;
}

std::vector<float> flat(const std::vector<Vector3>& vectors) {
    std::vector<float> out;
    out.reserve(3 * vectors.size());
    for (const Vector3& v : vectors) out.insert(out.end(), v.begin(), v.end());
    return out;
}

}  // namespace

Simulation::Simulation(const Scene& scene)
    : scene_(scene),
      solver_(solver_settings(scene), Boundary(scene.tank, scene.obstacle, 4.0F * scene.particle_radius)) {
    solver_.add(scene_.particles, {});
    came_in_.resize(solver_.count(), time_);
    if (scene_.nozzle) layer_ = disc(*scene_.nozzle, scene_.particle_radius);
}

void Simulation::advance(double seconds) {
    constexpr double instant = 1e-6;  // seconds; rounding makes times differ that should not
    const double end = time_ + seconds;
    while (time_ < end - instant) {
        if (time_ > next_layer_ - instant) pour();
        const double until = solver_.count() < scene_.total_particles ? std::min(end, next_layer_) : end;
        solver_.advance(until - time_);
        time_ = until;
    }
}

void Simulation::pour() {
    if (solver_.count() >= scene_.total_particles) return;
    std::vector<Vector3> layer = layer_;
    layer.resize(std::min(layer.size(), scene_.total_particles - solver_.count()));
    // A perfectly symmetric jet would stack up on the top of the obstacle, as no real one does.
    for (Vector3& p : layer)
        for (const std::size_t axis : {0U, 2U}) p[axis] += 0.2F * scene_.particle_radius * noise();
    solver_.add(layer, {0.0F, -scene_.nozzle->speed, 0.0F});
    came_in_.resize(solver_.count(), time_);
    next_layer_ += 2.0 * static_cast<double>(scene_.particle_radius) / static_cast<double>(scene_.nozzle->speed);
}

float Simulation::noise() {
    // mt19937's numbers are the same everywhere, which the standard's distributions are not.
    return static_cast<float>(random_() >> 8) / static_cast<float>(1U << 23) - 1.0F;
}

std::vector<float> Simulation::positions() const {
    return flat(solver_.positions());
}

std::vector<float> Simulation::velocities() const {
    return flat(solver_.velocities());
}

std::vector<float> Simulation::ages() const {
    std::vector<float> out;
    out.reserve(came_in_.size());
    for (const double time : came_in_) out.push_back(static_cast<float>(time_ - time));
    return out;
}

}  // namespace meniscus::simulator
