// The settings of a reconstruction.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "meniscus/described.hpp"

namespace meniscus {

/// The scalar function whose iso-surface is the fluid surface: a sum over particles (core/README.md#fields).
enum class Field : std::uint8_t {
    color,    ///< (m_j / rho_j) W(x - x_j, h) with a cubic spline, rho_j from the same kernel
    density,  ///< m_j W(x - x_j, h) with a cubic spline, relative to the rest density (the paper's Equation 1)
    smooth,   ///< V_j W(x - x_j, h_j), the support h_j wide among other particles and narrow for one alone
};
constexpr std::string_view name_of(Field field) {
    switch (field) {
        case Field::color:
            return "color";
        case Field::density:
            return "density";
        case Field::smooth:
            return "smooth";
    }
    return {};
}

/// What becomes of particles without company, with Field::smooth.
enum class Spray : std::uint8_t {
    keep,     ///< part of the surface, as drops
    discard,  ///< left out
    points,   ///< left out of the surface, and listed in Mesh::spray
};
constexpr std::string_view name_of(Spray spray) {
    switch (spray) {
        case Spray::keep:
            return "keep";
        case Spray::discard:
            return "discard";
        case Spray::points:
            return "points";
    }
    return {};
}

enum class Mode : std::uint8_t {
    adaptive,  ///< three levels of grid
    uniform,   ///< marching cubes at the finest cell: the paper's baseline
};
constexpr std::string_view name_of(Mode mode) {
    switch (mode) {
        case Mode::adaptive:
            return "adaptive";
        case Mode::uniform:
            return "uniform";
    }
    return {};
}

struct Settings;

// The settings in force: as given, or the default of the field.

/// Radii.
double smoothing_length(const Settings& settings);
/// Radii.
std::uint32_t smoothness(const Settings& settings);
/// The distance from which no particle of level 0 counts, radii: twice the smoothing length, or the smoothness.
double support(const Settings& settings);
/// Finest cells, with CurvatureCriterion.
double tolerance(const Settings& settings);
/// All of them: the same settings with the defaults of their field written out, as a server answers them.
Settings in_force(Settings settings);

/// A base cell's level by how much the surface bends in the cell.
struct CurvatureCriterion {
    static constexpr std::string_view name = "curvature";
    /// How far the surface may depart from that of the finest cells, in finest cells, > 0: about the 99th percentile of
    /// the distance between the two. None: as tolerance(Settings) has it for the field.
    std::optional<double> tolerance;

    template <class Visit>
    static void rows(const Visit& visit) {
        visit("tolerance", &CurvatureCriterion::tolerance,
              {.help = "how far the surface may depart from that of the finest cells, in those; the default is that of "
                       "the default field",
               .unit = "finest cells",
               .range = {.least = above_zero},
               .when = "--criterion curvature"},
              meniscus::tolerance);
    }
    bool operator==(const CurvatureCriterion&) const = default;
};

/// A base cell's level by the number of particles in the cell (the paper's Step 2).
struct CountCriterion {
    static constexpr std::string_view name = "count";
    /// A base cell is of level 3 if it holds 1 to this many particles; for adaptive SPH, if it holds at least this many
    /// particles of level 0. At least 1.
    std::uint32_t threshold = 1;

    template <class Visit>
    static void rows(const Visit& visit) {
        visit("threshold", &CountCriterion::threshold,
              {.help = "particles per base cell that decide about level 3",
               .range = {.least = 1.0},
               .when = "--criterion count",
               .subject = "count threshold is",
               .option = "count-threshold"});
    }
    bool operator==(const CountCriterion&) const = default;
};

/// How the level of a base cell is decided, in Mode::adaptive.
using Criterion = std::variant<CurvatureCriterion, CountCriterion>;

/// The point on an edge that crosses the surface: linearly between the two ends of the finest lattice edge.
struct Interpolation {
    static constexpr std::string_view name = "interpolate";
    std::uint32_t offset_bits() const { return 6; }

    template <class Visit>
    static void rows(const Visit&) {}
    bool operator==(const Interpolation&) const = default;
};

/// The same point by the paper's bisection of the field (Step 6).
struct Bisection {
    static constexpr std::string_view name = "bisect";
    static constexpr std::uint32_t max_steps = 7;
    std::uint32_t steps = 5;  ///< iterations on a level-3 edge (one and two more on levels 2 and 1), 1 to max_steps
    /// Bisection ends in the middle of an interval of c / 2^steps.
    std::uint32_t offset_bits() const { return steps + 1; }

    template <class Visit>
    static void rows(const Visit& visit) {
        visit("steps", &Bisection::steps,
              {.help = "iterations on a finest edge",
               .range = {.least = 1.0, .most = max_steps},
               .when = "--edge-points bisect",
               .subject = "bisection steps are",
               .option = "bisection-steps"});
    }
    bool operator==(const Bisection&) const = default;
};

/// How the point on an edge that crosses the surface is found.
using EdgePoints = std::variant<Interpolation, Bisection>;

inline constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};

/// An axis-aligned box, world units.
struct Box {
    std::array<double, 3> min{};
    std::array<double, 3> max{};

    template <class Visit>
    static void rows(const Visit& visit) {
        visit("min", &Box::min, {.help = "Smallest corner", .unit = "world units", .entries = axes});
        visit("max", &Box::max, {.help = "Largest corner", .unit = "world units", .entries = axes});
    }
    bool operator==(const Box&) const = default;
};

inline constexpr std::uint32_t min_smoothness = 5;
inline constexpr std::uint32_t max_smoothness = 7;

/// All lengths but the first are in multiples of the particle radius, as in splashsurf.
struct Settings {
    double particle_radius = 0.0;  ///< world units, finite, > 0; that of level 0 for adaptive SPH
    double cell_size = 0.5;  ///< radii, > 0: edge of a finest cell; at least support/256 of the coarsest particle level
    double iso = 0.6;        ///< field value at the surface, > 0; Field::smooth: < 1
    Field field = Field::smooth;
    /// Field::color and Field::density only: > 0; the kernel's support is twice that. None: 2.
    std::optional<double> smoothing_length;
    /// Field::smooth only: the widest support, 5, 6 or 7 (smoother, and slower). None: 6.
    std::optional<std::uint32_t> smoothness;
    Spray spray = Spray::keep;  ///< others than keep with Field::smooth only
    Mode mode = Mode::adaptive;
    Criterion criterion;     ///< by curvature unless another is chosen
    EdgePoints edge_points;  ///< interpolated unless bisection is chosen
    /// Whether vertices get normals, from the field's gradient. Without, a frame is done about a fifth sooner.
    bool normals = true;
    /// Crops the surface, closed at the border; rounded outward to whole finest cells. None: no limit.
    std::optional<Box> domain;
    /// Names of the particles' arrays that become attributes of the vertices, at most max_particle_arrays, each once: 1
    /// to 64 of a-z, 0-9 and _, other than "position" and "level". Frames must bring them.
    std::vector<std::string> attributes;
    /// Every array that the first frame brings becomes one, and further frames must bring it; `attributes` is empty.
    bool all_attributes = false;

    /// Ranges lie far beyond any fluid; within them no quotient, product or sum leaves its type: lengths in the world
    /// (squared, cubed, and divided into units, in float64), kernels of their length and thresholds (in float32).
    template <class Visit>
    static void rows(const Visit& visit) {
        constexpr std::string_view surface = "Surface", grid = "Grid";
        visit("particle_radius", &Settings::particle_radius,
              {.help = "Radius of the particles, world units",
               .unit = "world units",
               .range = {1e-60, 1e60, "take another unit of length"},
               .letter = 'r',
               .standard = "required",
               .by_hand = true});
        visit("cell_size", &Settings::cell_size,
              {.help = "Edge of a finest cell, in particle radii",
               .unit = "radii",
               .range = {1e-9, 1e9, "it is in particle radii"},
               .letter = 'c',
               .group = surface});
        visit("iso", &Settings::iso,
              {.help = "Field value at the surface; with the field smooth less than 1, and 0.4 to 0.7 as a rule",
               .range = {above_zero, 1e30, "inside a fluid the field is about 1"},
               .subject = "iso value is",
               .letter = 't',
               .group = surface});
        visit("field", &Settings::field, {.help = "Function whose iso-surface is the fluid surface", .group = surface});
        visit("smoothness", &Settings::smoothness,
              {.help = "the widest support in particle radii, 5 to 7; more is smoother and slower",
               .unit = "radii",
               .range = {min_smoothness, max_smoothness},
               .when = "--field smooth",
               .subject = "the smoothness is",
               .group = surface},
              meniscus::smoothness);
        visit("spray", &Settings::spray,
              {.help = "particles without company become drops (keep), are left out (discard), or are left out and "
                       "listed beside the surface (points)",
               .when = "--field smooth",
               .group = surface});
        visit("attributes", &Settings::attributes,
              {.help = "Array of the particles whose values the vertices get, such as velocity; once for each; all: "
                       "every array that the first frame brings",
               .option = "attribute",
               .group = surface,
               .by_hand = true});
        visit("all_attributes", &Settings::all_attributes,
              {.help = "Every array that the first frame brings becomes an attribute", .by_hand = true});
        visit("smoothing_length", &Settings::smoothing_length,
              {.help = "in particle radii; the kernel's support is twice that",
               .unit = "radii",
               .range = {1e-6, 1e6, "it is in particle radii"},
               .when = "--field color or density",
               .letter = 'l',
               .group = surface},
              meniscus::smoothing_length);
        visit("mode", &Settings::mode, {.help = "Three levels of grid, or the finest cell everywhere", .group = grid});
        visit("criterion", &Settings::criterion, {.help = "How the level of a base cell is decided", .group = grid});
        visit("edge_points", &Settings::edge_points, {.help = "How the point on an edge is found", .group = grid});
        visit("normals", &Settings::normals, {.help = "Whether vertices get normals (the default)", .group = surface});
        visit("domain", &Settings::domain,
              {.help = "crops the surface, world units",
               .unit = "world units",
               .argument = "X0 Y0 Z0 X1 Y1 Z1",
               .group = surface});
    }

    bool operator==(const Settings&) const = default;
};

/// Throws InvalidInput naming the first setting that is out of range, its value and the range.
void validate(const Settings& settings);

/// Settings that have a name; single ones may be changed afterwards.
enum class Preset : std::uint8_t {
    smooth,      ///< the defaults
    paper,       ///< Du and Kanai 2014: Equation 1, particle counts, five bisections
    splashsurf,  ///< the surface of splashsurf without smoothing: its field, at the finest cell everywhere
};
constexpr std::string_view name_of(Preset preset) {
    switch (preset) {
        case Preset::smooth:
            return "smooth";
        case Preset::paper:
            return "paper";
        case Preset::splashsurf:
            return "splashsurf";
    }
    return {};
}
Settings preset(Preset preset, double particle_radius);

/// How far from the border of a part of a frame particles decide about the surface inside of it, radii of the coarsest
/// particles: with all that lie within this margin of Settings::domain, the mesh is that of the whole frame to the bit
/// (core/README.md#parts-of-a-frame).
double margin(const Settings& settings);

/// The finest cell's edge in world units.
inline double world_cell_size(const Settings& s) {
    return s.cell_size * s.particle_radius;
}

/// Vertices lie on multiples of c / 2^offset_bits, min_ to max_offset_bits of mesh.hpp.
inline std::uint32_t offset_bits(const Settings& s) {
    return std::visit([](const auto& edge_points) { return edge_points.offset_bits(); }, s.edge_points);
}

/// The parameters of one alternative of a choice; their defaults if another is chosen.
template <class Chosen, class... T>
Chosen value_or_default(const std::variant<T...>& choice) {
    const auto* chosen = std::get_if<Chosen>(&choice);
    return chosen != nullptr ? *chosen : Chosen{};
}

}  // namespace meniscus
