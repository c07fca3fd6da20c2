// Incompressible SPH: a pressure that keeps density and divergence, found by relaxed Jacobi iterations.
//
// After Bender and Koschier, "Divergence-Free SPH for Incompressible and Viscous Fluids" (2017): one solve makes the
// velocity field free of divergence where it compresses, a second one makes the density after the step the rest
// density. All particles have the same mass; densities are relative to rest. Single-threaded and in a fixed order: the
// same input gives the same bits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "simulator/boundary.hpp"
#include "simulator/cell_grid.hpp"
#include "simulator/neighbors.hpp"

namespace meniscus::simulator {

struct SolverSettings {
    float particle_radius = 0.025F;   ///< meters; particles at rest are two radii apart
    float gravity = 9.81F;            ///< m/s^2, along -y
    float viscosity = 6.0F;           ///< 1/s: rate at which a particle takes on its neighbors' velocity
    float density_tolerance = 2e-3F;  ///< mean compression that ends the iterations
    int min_iterations = 2;
    int max_iterations = 40;  ///< of each solve
};

class Solver {
public:
    Solver(const SolverSettings& settings, const Boundary& boundary);

    /// At rest distance from each other and from what is there already.
    void add(std::span<const Vector3> positions, const Vector3& velocity);
    /// Goes on by `seconds` in steps that the fastest particle allows.
    void advance(double seconds);

    std::size_t count() const { return positions_.size(); }
    /// In the order in which they were added.
    std::vector<Vector3> positions() const { return as_added(positions_); }
    /// m/s, likewise.
    std::vector<Vector3> velocities() const { return as_added(velocities_); }
    /// Kinetic and potential energy over mass, (m/s)^2 summed over particles.
    double energy() const;
    std::uint64_t steps() const { return steps_; }

private:
    /// correction: the part of a compression that this step takes back, 0 to 1.
    void step(float dt, float correction);
    void sort();
    void compute_densities();
    void apply_forces(float dt);
    /// Changes velocities_ by the pressure that takes back compression(i), the relative one of particle i over this
    /// step.
    template <class Compression>
    void solve(std::vector<float>& pressure, float dt, const Compression& compression);
    void solve_divergence(float dt);
    void solve_density(float dt, float correction);
    /// predicted_ from velocities_ and pressures.
    void accelerate(const std::vector<float>& pressure, float dt);
    /// rate_ from predicted_.
    void compute_rates();
    float time_step() const;
    std::vector<Vector3> as_added(const std::vector<Vector3>& values) const;

    SolverSettings settings_;
    Boundary boundary_;
    float support_;
    CubicSpline kernel_;
    CellGrid grid_;
    Neighbors neighbors_;

    std::vector<Vector3> positions_;
    std::vector<Vector3> velocities_;
    std::vector<std::uint32_t> ids_;
    std::vector<float> density_pressure_;  ///< of the last step: where the next one starts
    std::vector<float> divergence_pressure_;

    std::vector<float> density_;
    std::vector<float> response_;  ///< how much a particle's own pressure lowers its compression
    std::vector<Vector3> boundary_gradient_;
    std::vector<Vector3> predicted_;  ///< velocities with the pressure applied
    std::vector<float> relaxation_;   ///< of each particle's pressure
    std::vector<float> residual_;     ///< of the iteration before
    std::vector<float> rate_;         ///< d density / dt with the predicted velocities
    std::uint64_t steps_ = 0;
};

}  // namespace meniscus::simulator
