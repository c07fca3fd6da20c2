// The bend of the surface in a base cell, known before the cell is sampled.
#pragma once

namespace meniscus {

/// An estimate of the surface in a cell of the band; zeros outside of the band and where none is found.
struct CellBend {
    float curvature;  ///< sum of both principal curvatures' magnitudes, times c
    float trace;      ///< of the tangential part of the field's Hessian, times c^2: below zero where the fluid bulges
    int least_level;  ///< least level for a surface that no corner shows: curvature does not see it
};

}  // namespace meniscus
