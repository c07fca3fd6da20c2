// Finds the points near a place: lists by cells of a grid over a box.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "compare/surface.hpp"

namespace meniscus::benchmarks::quality {

class Grid {
public:
    /// edge: the least edge of a cell. period: of the box along each axis, its extent there, which is to be at least
    /// three edges; 0: none.
    Grid(const compare::Point& low, const compare::Point& high, double edge, const std::array<double, 3>& period = {})
        : low_(low), period_(period) {
        for (std::size_t a = 0; a < 3; ++a) {
            const double extent = high[a] - low[a];
            count_[a] = std::max(static_cast<int>(extent / edge), 1);
            scale_[a] = extent > 0.0 ? count_[a] / extent : 0.0;
        }
    }

    /// Points outside of the box count to its nearest cell.
    void fill(const std::vector<compare::Point>& points) {
        lists_.resize(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) *
                      static_cast<std::size_t>(count_[2]));
        for (std::vector<std::size_t>& list : lists_) list.clear();
        for (std::size_t i = 0; i < points.size(); ++i) lists_[index(cell(points[i]))].push_back(i);
    }

    /// Calls visit(i) once for every point in the 27 cells around p: all that are within an edge of it, and others.
    void for_each_near(const compare::Point& p, const auto& visit) const {
        const std::array<int, 3> middle = cell(p);
        for (int dz = -1; dz <= 1; ++dz)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    std::array<int, 3> at{middle[0] + dx, middle[1] + dy, middle[2] + dz};
                    if (!wrap(at)) continue;
                    for (const std::size_t i : lists_[index(at)]) visit(i);
                }
    }

private:
    std::array<int, 3> cell(const compare::Point& p) const {
        std::array<int, 3> c{};
        for (std::size_t a = 0; a < 3; ++a)
            c[a] = std::clamp(static_cast<int>(std::floor((p[a] - low_[a]) * scale_[a])), 0, count_[a] - 1);
        return c;
    }
    /// Whether the cell is of the grid, after its periods.
    bool wrap(std::array<int, 3>& at) const {
        for (std::size_t a = 0; a < 3; ++a) {
            if (period_[a] > 0.0)
                at[a] = (at[a] + count_[a]) % count_[a];
            else if (at[a] < 0 || at[a] >= count_[a])
                return false;
        }
        return true;
    }
    std::size_t index(const std::array<int, 3>& at) const {
        return static_cast<std::size_t>((at[2] * count_[1] + at[1]) * count_[0] + at[0]);
    }

    compare::Point low_;
    std::array<double, 3> period_;
    std::array<int, 3> count_{};
    compare::Point scale_{};
    std::vector<std::vector<std::size_t>> lists_;
};

}  // namespace meniscus::benchmarks::quality
