// A frame's figures in words, for people.
#pragma once

#include <string>

#include "meniscus/statistics.hpp"

namespace meniscus::cli {

/// "11492 particles, 54321 triangles, 0.03 s"
std::string summary(const Statistics& statistics);

/// The lines that -v adds: one of vertices and memory, and one of the time of each step.
std::string stages_text(const Statistics& statistics);

}  // namespace meniscus::cli
