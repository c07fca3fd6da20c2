// Real frames, by their numbers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "quality/surfaces.hpp"

namespace meniscus::benchmarks::quality {

/// The files frame_NNN.vtk below a folder.
class FrameFiles {
public:
    /// folder: empty: that of the environment's MENISCUS_DATA. Without either there are no frames.
    explicit FrameFiles(std::filesystem::path folder);

    /// wanted: numbers, "odd" or "even" (all frames of such numbers). Numbers of which there is no file are left out.
    /// Ascending. Throws InvalidInput for another word.
    std::vector<unsigned> choose(const std::vector<std::string>& wanted) const;
    bool has(unsigned number) const;

    /// Named "frame_040". Throws InvalidInput if it cannot be read.
    Cloud read(unsigned number) const;

private:
    std::vector<std::pair<unsigned, std::filesystem::path>> files_;  ///< ascending
};

}  // namespace meniscus::benchmarks::quality
