// A scene that moves.
#pragma once

#include <random>
#include <vector>

#include "simulator/scene.hpp"
#include "simulator/solver.hpp"

namespace meniscus::simulator {

class Simulation {
public:
    explicit Simulation(const Scene& scene);

    /// Goes on by `seconds`.
    void advance(double seconds);

    double time() const { return time_; }
    const Scene& scene() const { return scene_; }
    const Solver& solver() const { return solver_; }
    /// x y z per particle, meters, in the order in which they came in.
    std::vector<float> positions() const;
    /// x y z per particle, m/s, in the same order.
    std::vector<float> velocities() const;
    /// Seconds since each particle came in, in the same order.
    std::vector<float> ages() const;

private:
    void pour();
    /// -1 to 1, the same sequence in every run.
    float noise();

    Scene scene_;
    Solver solver_;
    std::vector<Vector3> layer_;  ///< what the nozzle adds at a time
    std::mt19937 random_{1};
    double time_ = 0.0;
    double next_layer_ = 0.0;      ///< time at which it does
    std::vector<double> came_in_;  ///< time at which each particle did
};

}  // namespace meniscus::simulator
