// Gain and cost of the adaptive grid: its surfaces against those of the finest cells, and their times.
#pragma once

#include <vector>

#include "quality/figures.hpp"
#include "quality/frame_files.hpp"

namespace meniscus::benchmarks::quality {

/// Triangles, distances in cells, lost components. fields: the settings, whose mode does not count.
void measure_levels(const std::vector<Settings>& fields, const std::vector<Cloud>& frames, Figures& figures);

/// Triangles again, of a frame moved along y in steps of half a cell: how much a calm surface's height on the lattice
/// matters.
void measure_heights_on_lattice(const std::vector<Settings>& fields, const Cloud& frame, Figures& figures);

/// Warm processor times of both modes, on one thread: medians of `runs`, all fields and modes in turn.
void measure_times(const std::vector<Settings>& fields, const std::vector<Cloud>& frames, unsigned runs,
                   Figures& figures);

}  // namespace meniscus::benchmarks::quality
