// The mesh of the C interface: the library's, and the arrays that are made of it when they are asked for.
#pragma once

#include <cstdint>
#include <vector>

#include "meniscus/meniscus.h"
#include "meniscus/mesh.hpp"
#include "meniscus/statistics.hpp"

struct meniscus_mesh {
    meniscus::Mesh content;
    meniscus::Statistics statistics;  ///< of the frame that it is of
    // Empty until they are asked for.
    std::vector<double> vertices;
    std::vector<float> vertices_float;
    std::vector<std::uint8_t> triangle_levels;
    std::vector<meniscus_array> attributes;

    /// Empties the arrays before `content` is filled anew: their memory stays.
    void forget_arrays() noexcept {
        vertices.clear();
        vertices_float.clear();
        triangle_levels.clear();
        attributes.clear();
    }
};
