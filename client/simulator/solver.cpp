#include "simulator/solver.hpp"

#include <algorithm>
#include <cmath>

namespace meniscus::simulator {
namespace {

/// The kernel's support in particle radii: the smoothing length is the rest distance.
constexpr float support_in_radii = 4.0F;
/// The part of the rest distance that the fastest particle may go in one step.
constexpr float courant = 0.4F;
/// Of the Jacobi iteration, at first; 1 would not converge.
constexpr float relaxation = 0.5F;
/// How near a particle's center may come to a wall, in radii.
constexpr float clearance = 0.5F;
/// Fewer neighbors than this are spray, whose divergence means nothing.
constexpr std::size_t dense_neighbors = 18;

float cube(float x) {
    return x * x * x;
}

template <class T>
void reorder(std::vector<T>& values, const std::vector<std::uint32_t>& order, std::vector<T>& scratch) {
    scratch.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) scratch[i] = values[order[i]];
    values.swap(scratch);
}

}  // namespace

Solver::Solver(const SolverSettings& settings, const Boundary& boundary)
    : settings_(settings),
      boundary_(boundary),
      support_(support_in_radii * settings.particle_radius),
      kernel_(support_, cube(2.0F * settings.particle_radius)),
      grid_(boundary.tank().size, support_) {}

void Solver::add(std::span<const Vector3> positions, const Vector3& velocity) {
    for (const Vector3& p : positions) {
        ids_.push_back(static_cast<std::uint32_t>(ids_.size()));
        positions_.push_back(p);
        velocities_.push_back(velocity);
        density_pressure_.push_back(0.0F);
        divergence_pressure_.push_back(0.0F);
    }
}

void Solver::advance(double seconds) {
    double done = 0.0;
    while (done < seconds) {
        const double left = seconds - done;
        const double allowed = time_step();
        double dt = std::min(left, allowed);
        if (left < 2.0 * dt && left > dt) dt = 0.5 * left;  // two equal steps rather than a tiny last one
        // A compression is corrected within an allowed step: within a much shorter one it would tear the water apart.
        step(static_cast<float>(dt), static_cast<float>(dt / allowed));
        done += dt;
    }
}

float Solver::time_step() const {
    float fastest = 0.0F;
    for (const Vector3& v : velocities_) fastest = std::max(fastest, dot(v, v));
    const float distance = 2.0F * settings_.particle_radius;
    // From rest, gravity alone covers the allowed way in sqrt(2 s / g).
    const float at_rest = 0.25F * std::sqrt(2.0F * courant * distance / settings_.gravity);
    return std::min(at_rest, courant * distance / std::max(1e-6F, std::sqrt(fastest)));
}

void Solver::step(float dt, float correction) {
    if (positions_.empty()) return;
    sort();
    neighbors_.find(positions_, grid_, kernel_, support_);
    compute_densities();
    solve_divergence(dt);
    apply_forces(dt);
    solve_density(dt, correction);
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        for (std::size_t a = 0; a < 3; ++a) positions_[i][a] += dt * velocities_[i][a];
        boundary_.keep_out(positions_[i], velocities_[i], clearance * settings_.particle_radius);
    }
    ++steps_;
}

void Solver::sort() {
    const std::vector<std::uint32_t>& order = grid_.sort(positions_);
    reorder(positions_, order, predicted_);
    reorder(velocities_, order, predicted_);
    reorder(density_pressure_, order, rate_);
    reorder(divergence_pressure_, order, rate_);
    std::vector<std::uint32_t> ids;
    reorder(ids_, order, ids);
}

void Solver::compute_densities() {
    const std::size_t count = positions_.size();
    density_.resize(count);
    response_.resize(count);
    boundary_gradient_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const BoundaryDensity wall = boundary_.density(positions_[i]);
        float density = kernel_.value(0.0F) + wall.value;
        Vector3 sum{};
        float squares = 0.0F;
        for (std::size_t k = neighbors_.offsets[i]; k < neighbors_.offsets[i + 1]; ++k) {
            const Vector3 g{neighbors_.gradient_x[k], neighbors_.gradient_y[k], neighbors_.gradient_z[k]};
            density += neighbors_.weight[k];
            squares += dot(g, g);
            for (std::size_t a = 0; a < 3; ++a) sum[a] += g[a];
        }
        density_[i] = density;
        boundary_gradient_[i] = wall.gradient;
        // The wall mirrors the pressure, so it pushes twice, but it does not move.
        Vector3 felt{};
        Vector3 pushed{};
        for (std::size_t a = 0; a < 3; ++a) {
            felt[a] = sum[a] + wall.gradient[a];
            pushed[a] = sum[a] + 2.0F * wall.gradient[a];
        }
        const float denominator = std::max(0.0F, dot(felt, pushed)) + squares;
        // Lone particles have nothing to push against.
        response_[i] = denominator > 1e-6F / (support_ * support_) ? 1.0F / denominator : 0.0F;
    }
}

void Solver::apply_forces(float dt) {
    const float blend = std::min(0.5F, settings_.viscosity * dt);
    predicted_.resize(positions_.size());
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        Vector3 drag{};
        for (std::size_t k = neighbors_.offsets[i]; k < neighbors_.offsets[i + 1]; ++k) {
            const Vector3& other = velocities_[neighbors_.index[k]];
            for (std::size_t a = 0; a < 3; ++a) drag[a] += neighbors_.weight[k] * (other[a] - velocities_[i][a]);
        }
        for (std::size_t a = 0; a < 3; ++a) predicted_[i][a] = velocities_[i][a] + blend * drag[a];
        predicted_[i][1] -= dt * settings_.gravity;
    }
    velocities_.swap(predicted_);
}

void Solver::accelerate(const std::vector<float>& pressure, float dt) {
    predicted_.resize(positions_.size());
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        const float own = pressure[i];
        Vector3 sum{};
        for (std::size_t a = 0; a < 3; ++a) sum[a] = 2.0F * own * boundary_gradient_[i][a];
        for (std::size_t k = neighbors_.offsets[i]; k < neighbors_.offsets[i + 1]; ++k) {
            const float both = own + pressure[neighbors_.index[k]];
            sum[0] += both * neighbors_.gradient_x[k];
            sum[1] += both * neighbors_.gradient_y[k];
            sum[2] += both * neighbors_.gradient_z[k];
        }
        for (std::size_t a = 0; a < 3; ++a) predicted_[i][a] = velocities_[i][a] - dt * sum[a];
    }
}

void Solver::compute_rates() {
    rate_.resize(positions_.size());
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        const Vector3 own = predicted_[i];
        float rate = dot(own, boundary_gradient_[i]);
        for (std::size_t k = neighbors_.offsets[i]; k < neighbors_.offsets[i + 1]; ++k) {
            const Vector3& other = predicted_[neighbors_.index[k]];
            rate += (own[0] - other[0]) * neighbors_.gradient_x[k] + (own[1] - other[1]) * neighbors_.gradient_y[k] +
                    (own[2] - other[2]) * neighbors_.gradient_z[k];
        }
        rate_[i] = rate;
    }
}

template <class Compression>
void Solver::solve(std::vector<float>& pressure, float dt, const Compression& compression) {
    // Half of the last step's pressure is a start that does not overshoot.
    for (float& p : pressure) p *= 0.5F;
    relaxation_.assign(positions_.size(), relaxation);
    residual_.assign(positions_.size(), 0.0F);
    for (int iteration = 0; iteration < settings_.max_iterations; ++iteration) {
        accelerate(pressure, dt);
        compute_rates();
        double error = 0.0;
        for (std::size_t i = 0; i < positions_.size(); ++i) {
            const float residual = compression(i);
            // Where particles crowd, Jacobi's steps overshoot ever further: shorter ones there.
            if (residual * residual_[i] < 0.0F && std::abs(residual) > 0.7F * std::abs(residual_[i]))
                relaxation_[i] *= 0.5F;
            residual_[i] = residual;
            pressure[i] = std::max(0.0F, pressure[i] + relaxation_[i] * residual * response_[i] / (dt * dt));
            error += static_cast<double>(std::max(0.0F, residual));
        }
        const double mean = error / static_cast<double>(positions_.size());
        if (iteration + 1 >= settings_.min_iterations && mean <= static_cast<double>(settings_.density_tolerance))
            break;
    }
    accelerate(pressure, dt);
    velocities_.swap(predicted_);
}

void Solver::solve_divergence(float dt) {
    solve(divergence_pressure_, dt, [&](std::size_t i) {
        const bool spray =
            neighbors_.offsets[i + 1] - neighbors_.offsets[i] < dense_neighbors && boundary_gradient_[i] == Vector3{};
        return spray || density_[i] + dt * rate_[i] < 0.95F ? -1.0F : dt * rate_[i];
    });
}

void Solver::solve_density(float dt, float correction) {
    solve(density_pressure_, dt, [&](std::size_t i) { return correction * (density_[i] - 1.0F) + dt * rate_[i]; });
}

std::vector<Vector3> Solver::as_added(const std::vector<Vector3>& values) const {
    std::vector<Vector3> out(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) out[ids_[i]] = values[i];
    return out;
}

double Solver::energy() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < positions_.size(); ++i)
        sum += 0.5 * static_cast<double>(dot(velocities_[i], velocities_[i])) +
               static_cast<double>(settings_.gravity) * static_cast<double>(positions_[i][1]);
    return sum;
}

}  // namespace meniscus::simulator
