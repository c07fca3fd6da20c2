// Plots of lines as SVG.
#pragma once

#include <string>
#include <vector>

namespace meniscus::benchmarks {

struct Line {
    std::string name;
    std::vector<double> values;  ///< one per x, not negative
};

struct LinePlot {
    std::string title;
    std::string x_label;
    std::string y_label;
    std::vector<double> x;  ///< ascending
    std::vector<Line> lines;
};

/// An image without background, in colors that are distinct on white and on black. The y axis starts at 0.
std::string to_svg(const LinePlot& plot);

}  // namespace meniscus::benchmarks
