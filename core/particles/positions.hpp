// A frame's positions, snapped to the lattice.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lattice/coordinates.hpp"
#include "lattice/host_device.hpp"
#include "meniscus/particle_frame.hpp"
#include "meniscus/settings.hpp"

namespace meniscus {

/// The coordinate that a number stands for between the ends of a quantization box, along one axis.
MENISCUS_HD inline double decoded(std::uint16_t number, double low, double high) {
    return low + static_cast<double>(number) * (high - low) / 65535.0;
}

/// Units of the lattice in one of the world's length: 4096 / c.
inline double units_per_length(const Settings& settings) {
    return units_per_cell / world_cell_size(settings);
}

/// The positions of a frame, in one of the two encodings of ParticleFrame.
struct PositionsView {
    const float* positions = nullptr;
    const std::uint16_t* quantized = nullptr;
    double low[3] = {}, high[3] = {};  ///< corners of the quantization box
    double units_per_length = 0.0;

    MENISCUS_HD Units3 snapped(std::size_t i) const {
        std::int64_t p[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double x = quantized != nullptr ? decoded(quantized[3 * i + axis], low[axis], high[axis])
                                                  : static_cast<double>(positions[3 * i + axis]);
            p[axis] = snap(x, units_per_length);
        }
        return {p[0], p[1], p[2]};
    }
};

/// The positions of a valid frame.
inline PositionsView positions_view(const ParticleFrame& frame, double units_per_length) {
    PositionsView view;
    if (frame.is_quantized())
        view.quantized = frame.quantized.data();
    else
        view.positions = frame.positions.data();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        view.low[axis] = frame.quantization_box.min[axis];
        view.high[axis] = frame.quantization_box.max[axis];
    }
    view.units_per_length = units_per_length;
    return view;
}

}  // namespace meniscus
