// What the example simulator can show.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "simulator/boundary.hpp"

namespace meniscus::simulator {

enum class SceneKind { dam_break, double_dam_break, pour_on_obstacle };
constexpr std::string_view name_of(SceneKind kind) {
    switch (kind) {
        case SceneKind::dam_break:
            return "dam-break";
        case SceneKind::double_dam_break:
            return "double-dam-break";
        case SceneKind::pour_on_obstacle:
            return "pour-on-obstacle";
    }
    return {};
}

/// Water that enters through a round nozzle in the lid, straight down.
struct Nozzle {
    Vector3 center{};     ///< meters
    float radius = 0.0F;  ///< meters
    float speed = 0.0F;   ///< m/s
};

struct Scene {
    float particle_radius = 0.0F;  ///< meters
    Tank tank;
    std::optional<Sphere> obstacle;
    std::vector<Vector3> particles;  ///< at the start, at rest
    std::optional<Nozzle> nozzle;
    std::size_t total_particles = 0;  ///< with all that the nozzle will add
};

/// A scene of fixed size in meters whose particles are as small as their number makes them: 16,000 have a radius of
/// 0.025 m. The dam breaks' tank is then 162 x 86 x 86 radii: 81 x 43 x 43 base cells at the default cell size, as in
/// the paper. Throws InvalidInput unless particles is 1 to 100 million and fits the tank.
Scene make_scene(SceneKind kind, std::size_t particles);

}  // namespace meniscus::simulator
