// What a user chooses about a reconstruction.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace meniscus {

/// The scalar function whose iso-surface is the fluid surface. Both are sums over particles of a cubic spline.
enum class Field : std::uint8_t {
    density,  ///< m_j W(x - x_j, h), relative to the rest density (the paper's Equation 1)
    color,    ///< (m_j / rho_j) W(x - x_j, h), rho_j from the same kernel
};

enum class Mode : std::uint8_t {
    adaptive,  ///< three levels of grid
    uniform,   ///< marching cubes at the finest cell: the paper's baseline
};

/// How the level of a base cell is decided.
enum class Criterion : std::uint8_t {
    curvature,  ///< by how much the surface bends in the cell
    count,      ///< by the number of particles in the cell (the paper's Step 2)
};

/// How the point on an edge that crosses the surface is found.
enum class EdgePoints : std::uint8_t {
    interpolate,  ///< linearly between the two ends of the finest lattice edge
    bisect,       ///< by the paper's bisection of the field (Step 6)
};

/// An axis-aligned box, world units.
struct Box {
    std::array<double, 3> min{};
    std::array<double, 3> max{};
    bool operator==(const Box&) const = default;
};

/// All lengths but the first are in multiples of the particle radius, as in splashsurf.
struct Settings {
    double particle_radius = 0.0;   ///< world units, finite, > 0; that of level 0 for adaptive SPH
    double smoothing_length = 2.0;  ///< radii, > 0; the kernel's support is twice that
    double cell_size = 0.5;  ///< radii, > 0: edge of a finest cell; at least support/256 of the coarsest particle level
    double iso = 0.6;        ///< field value at the surface, > 0
    Field field = Field::color;
    Mode mode = Mode::adaptive;
    Criterion criterion = Criterion::curvature;
    /// Criterion::curvature: how far the surface may depart from that of the finest cells, in finest cells, > 0: about
    /// the 99th percentile of the distance between the two.
    double tolerance = 0.15;
    /// Criterion::count: a base cell is of level 3 if it holds 1 to this many particles; for adaptive SPH, if it
    /// holds at least this many particles of level 0. At least 1.
    std::uint32_t count_threshold = 1;
    EdgePoints edge_points = EdgePoints::interpolate;
    /// EdgePoints::bisect: iterations on a level-3 edge (one and two more on levels 2 and 1), 1 to 7.
    std::uint32_t bisection_steps = 5;
    /// Whether vertices get normals, from the field's gradient. Without, a frame is done about a fifth sooner.
    bool normals = true;
    /// Crops the surface, closed at the border; rounded outward to whole finest cells. None: no limit.
    std::optional<Box> domain;

    bool operator==(const Settings&) const = default;
};

/// Throws InvalidInput naming the first setting that is out of range, its value and the range.
void validate(const Settings& settings);

/// The finest cell's edge in world units.
inline double world_cell_size(const Settings& s) {
    return s.cell_size * s.particle_radius;
}

/// Vertices lie on multiples of c / 2^offset_bits, 2 to 8: bisection ends in the middle of an interval of c / 2^steps.
inline std::uint32_t offset_bits(const Settings& s) {
    return s.edge_points == EdgePoints::bisect ? s.bisection_steps + 1 : 6;
}

enum class Backend : std::uint8_t { automatic, cpu, cuda };

/// "auto", "cpu" or "cuda". Throws InvalidInput for other names.
Backend backend_by_name(const std::string& name);

struct BackendOptions {
    Backend backend = Backend::automatic;
    unsigned threads = 0;                 ///< CPU worker threads; 0: one per processor
    std::size_t memory_limit = 0;         ///< bytes one reconstructor may hold; 0: no limit of its own
    int device = 0;                       ///< which GPU, see devices.hpp
    std::size_t device_memory_limit = 0;  ///< bytes one reconstructor may hold on the GPU; 0: no limit of its own
};

}  // namespace meniscus
