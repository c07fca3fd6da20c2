#include "cli/surfaces/quantized_positions.hpp"

#include <algorithm>
#include <cmath>

namespace meniscus::cli {

QuantizedPositions::QuantizedPositions(const ParticleFrame& frame) : levels_(frame.levels), arrays_(frame.arrays) {
    const std::span<const float> x = frame.positions;
    if (x.empty()) return;
    for (std::size_t a = 0; a < 3; ++a) box_.min[a] = box_.max[a] = static_cast<double>(x[a]);
    for (std::size_t i = 3; i < x.size(); ++i) {
        box_.min[i % 3] = std::min(box_.min[i % 3], static_cast<double>(x[i]));
        box_.max[i % 3] = std::max(box_.max[i % 3], static_cast<double>(x[i]));
    }
    values_.resize(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double extent = box_.max[i % 3] - box_.min[i % 3];
        const double part = extent > 0.0 ? (static_cast<double>(x[i]) - box_.min[i % 3]) / extent : 0.0;
        values_[i] = static_cast<std::uint16_t>(std::lround(65535.0 * part));
    }
}

ParticleFrame QuantizedPositions::frame() const {
    ParticleFrame view;
    view.quantized = values_;
    view.quantization_box = box_;
    view.levels = levels_;
    view.arrays = arrays_;
    return view;
}

}  // namespace meniscus::cli
