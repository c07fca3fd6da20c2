// Figures that were measured, as rows.
#pragma once

#include <string>
#include <vector>

#include "quality/surfaces.hpp"
#include "report.hpp"

namespace meniscus::benchmarks::quality {

/// One figure of a subject: of a shape, of a group, of a frame.
struct Figure {
    std::string name;  ///< name, with its unit where it has one: "offset_radii"
    double value = 0.0;
};

/// The subject of a figure.
struct Subject {
    std::string part;      ///< "shapes", "groups", "frames", "motion", "levels" or "times"
    std::string name;      ///< "ball10", "frame_040"
    std::string sampling;  ///< name of one of several whose mean counts; empty: there is one alone
};

class Figures {
public:
    void add(const Subject& subject, const Method& method, const std::vector<Figure>& figures);

    /// part, subject, sampling, field, mode, cell_size, figure, value.
    const Rows& rows() const { return rows_; }
    /// A table for each part, field, mode and cell size: means over the samplings, and each one's value in brackets.
    std::string text() const;

private:
    Rows rows_ = Rows::array();
};

}  // namespace meniscus::benchmarks::quality
