// What the GPU can do at best, measured.
#pragma once

#include "machine_peaks.hpp"

namespace meniscus::benchmarks {

/// Of the current CUDA device, all of it; throws std::runtime_error without one.
MachinePeaks measure_device_peaks();

}  // namespace meniscus::benchmarks
