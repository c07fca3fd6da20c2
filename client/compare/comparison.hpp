// Compares two surfaces: distance, components that only one has, size, closedness.
#pragma once

#include <cstddef>
#include <vector>

#include "compare/closedness.hpp"
#include "compare/surface_distance.hpp"

namespace meniscus::compare {

/// A component all of whose samples are farther than this from the other surface is missing there; in cells.
inline constexpr double missing_distance = 0.75;

struct Part {
    std::size_t triangles = 0;
    double area = 0.0;      ///< world units squared
    Point center{};         ///< mean of its samples, world units
    double distance = 0.0;  ///< of its nearest sample from the other surface, world units

    /// Whether the other surface misses this part. cell_size: edge of its cells, world units.
    bool missing(double cell_size) const { return distance > missing_distance * cell_size; }
};

/// One of the two surfaces, as compared with the other.
struct Side {
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    std::size_t samples = 0;
    double area = 0.0;  ///< world units squared
    Defects defects;
    DistanceSummary distance;  ///< from this surface to the other
    std::vector<Part> parts;   ///< its components, by their first triangles

    /// Parts that the other surface misses.
    std::vector<Part> missing(double cell_size) const;
    /// The largest distance of a part: below `missing_distance` cells nothing is missing. World units.
    double farthest_part() const;
};

struct Comparison {
    Side a;
    Side b;

    /// Two-sided: the larger of both directions, figure by figure.
    DistanceSummary distance() const;
    /// Triangles of a over those of b.
    double triangle_ratio() const;
};

/// samples: approximate number on each surface. The result is the same on every run.
Comparison compare_surfaces(SurfaceView a, SurfaceView b, std::size_t samples);

}  // namespace meniscus::compare
