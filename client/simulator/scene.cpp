#include "simulator/scene.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "meniscus/error.hpp"

namespace meniscus::simulator {
namespace {

constexpr std::size_t reference_particles = 16000;
constexpr double reference_radius = 0.025;
/// Height of a column of water over its width.
constexpr double column_aspect = 1.5;

/// `count` particles on a cubic lattice at rest distance, filled from the bottom: `along_x` of them in a row
/// along x, from `first_x` in direction `sign`, and `along_z` rows.
void fill_column(Scene& scene, std::size_t count, float first_x, float sign, std::size_t along_x, std::size_t along_z) {
    const float r = scene.particle_radius;
    for (std::size_t i = 0; i < count; ++i) {
        const auto x = static_cast<float>(i % along_x);
        const std::size_t row = i / along_x % along_z;
        const std::size_t layer = i / (along_x * along_z);
        scene.particles.push_back({first_x + sign * r * (2.0F * x + 1.0F),
                                   r * (2.0F * static_cast<float>(layer) + 1.0F),
                                   r * (2.0F * static_cast<float>(row) + 1.0F)});
    }
}

void fill_dams(Scene& scene, std::size_t columns) {
    const float distance = 2.0F * scene.particle_radius;
    const std::size_t each = (scene.total_particles + columns - 1) / columns;
    const auto along_z = static_cast<std::size_t>(std::lround(scene.tank.size[2] / distance));
    const double cross_section = static_cast<double>(each) / static_cast<double>(along_z);
    const auto along_x =
        std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(std::sqrt(cross_section / column_aspect))));
    fill_column(scene, each, 0.0F, 1.0F, along_x, along_z);
    if (columns == 2) fill_column(scene, scene.total_particles - each, scene.tank.size[0], -1.0F, along_x, along_z);
}

}  // namespace

Scene make_scene(SceneKind kind, std::size_t particles) {
    constexpr std::size_t limit = 100'000'000;
    if (particles < 1 || particles > limit)
        throw InvalidInput("a scene of " + std::to_string(particles) + " particles; 1 to " + std::to_string(limit) +
                           " are possible");
    Scene scene;
    scene.total_particles = particles;
    scene.particle_radius = static_cast<float>(
        reference_radius * std::cbrt(static_cast<double>(reference_particles) / static_cast<double>(particles)));
    constexpr auto side = static_cast<float>(86.0 * reference_radius);
    scene.tank.size = {static_cast<float>(162.0 * reference_radius), side, side};
    if (kind == SceneKind::pour_on_obstacle) {
        scene.tank.size[0] = side;
        scene.obstacle = Sphere{{0.5F * side, 0.35F * side, 0.5F * side}, 0.2F * side};
        scene.nozzle = Nozzle{
            {0.5F * side, 0.95F * side, 0.5F * side}, std::max(0.12F * side, 2.0F * scene.particle_radius), 2.5F};
    } else {
        fill_dams(scene, kind == SceneKind::dam_break ? 1 : 2);
    }
    return scene;
}

}  // namespace meniscus::simulator
