// The cases that are measured: particles, and figures of their surfaces.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "quality/figures.hpp"
#include "quality/frame_files.hpp"
#include "quality/surfaces.hpp"

namespace meniscus::benchmarks::quality {

struct Case {
    Subject subject;
    std::vector<Cloud> clouds;
    /// Figures of the clouds' surfaces, all of one method, in their order.
    std::function<std::vector<Figure>(const std::vector<Surface>&)> judge;
};

/// Known shapes, each in three samplings. names: of those wanted, all if there are none. Throws InvalidInput for a name
/// that is no shape's.
std::vector<Case> shape_cases(const std::vector<std::string>& names, double radius);
/// Few particles alone, in several placements.
std::vector<Case> group_cases(double radius);
/// Real frames: roughness, components.
std::vector<Case> frame_cases(const FrameFiles& files, const std::vector<unsigned>& numbers);
/// A ball moved by fractions of a cell, and a pool whose particles tremble: how far the surface moves against the
/// water. cell_size: radii.
std::vector<Case> motion_cases(double radius, double cell_size);
/// Real frames, each with the next one where that is there: how far the surface moves against the water where that
/// keeps its shape.
std::vector<Case> rest_cases(const FrameFiles& files, const std::vector<unsigned>& numbers, double radius);

}  // namespace meniscus::benchmarks::quality
