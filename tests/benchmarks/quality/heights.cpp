#include "quality/heights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meniscus/error.hpp"
#include "quality/triangle.hpp"

namespace meniscus::benchmarks::quality {
namespace {

constexpr double step = 0.25;  ///< radii between places

/// Rows of places from `low` to `high`.
struct Range {
    int first = 0;
    int last = -1;
};

/// The places low + (i + 1/2) step between two coordinates.
Range places_between(double from, double to, double low, int count) {
    return {std::max(static_cast<int>(std::ceil((from - low) / step - 0.5)), 0),
            std::min(static_cast<int>(std::floor((to - low) / step - 0.5)), count - 1)};
}

/// Raises the heights below one triangle to it.
class Raiser {
public:
    Raiser(const Rectangle& over, std::vector<double>& heights, int columns, int rows)
        : over_(over), heights_(heights), columns_(columns), rows_(rows) {}

    void raise(const Corners& c) {
        const double upward = area_normal(c)[2];
        if (!(upward > 0.0)) return;
        const Range x = extent(c, 0, columns_);
        const Range y = extent(c, 1, rows_);
        for (int j = y.first; j <= y.last; ++j)
            for (int i = x.first; i <= x.last; ++i) {
                const Point at{over_.low[0] + (i + 0.5) * step, over_.low[1] + (j + 0.5) * step, 0.0};
                const double a = across(at, c[1], c[2]) / upward;
                const double b = across(at, c[2], c[0]) / upward;
                if (a < 0.0 || b < 0.0 || a + b > 1.0) continue;
                double& height = heights_[static_cast<std::size_t>(j * columns_ + i)];
                height = std::max(height, a * c[0][2] + b * c[1][2] + (1.0 - a - b) * c[2][2]);
            }
    }

private:
    Range extent(const Corners& c, std::size_t axis, int count) const {
        const auto [least, most] = std::minmax({c[0][axis], c[1][axis], c[2][axis]});
        return places_between(least, most, over_.low[axis], count);
    }
    /// Twice the area, seen from above, of the triangle of three points.
    static double across(const Point& p, const Point& q, const Point& r) {
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    }

    const Rectangle& over_;
    std::vector<double>& heights_;
    int columns_;
    int rows_;
};

}  // namespace

std::vector<double> heights_of(compare::SurfaceView surface, const Rectangle& over) {
    const int columns = static_cast<int>((over.high[0] - over.low[0]) / step);
    const int rows = static_cast<int>((over.high[1] - over.low[1]) / step);
    std::vector<double> heights(static_cast<std::size_t>(columns * rows), -std::numeric_limits<double>::infinity());
    Raiser raiser(over, heights, columns, rows);
    for (const Triangle& t : surface.triangles) raiser.raise(surface.corners(t));
    return heights;
}

double height_motion(compare::SurfaceView from, compare::SurfaceView to, const Rectangle& over) {
    const std::vector<double> before = heights_of(from, over);
    const std::vector<double> after = heights_of(to, over);
    double squares = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const double moved = after[i] - before[i];
        if (!std::isfinite(moved)) throw InvalidInput("the surface has a hole where its height is measured");
        squares += moved * moved;
    }
    return std::sqrt(squares / static_cast<double>(before.size()));
}

}  // namespace meniscus::benchmarks::quality
