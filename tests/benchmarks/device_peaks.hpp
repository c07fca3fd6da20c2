// The GPU's peaks, measured.
#pragma once

#include "machine_peaks.hpp"

namespace meniscus::benchmarks {

/// The peaks of the whole of the current CUDA device; throws std::runtime_error without one.
MachinePeaks measure_device_peaks();

}  // namespace meniscus::benchmarks
