#include <stdexcept>

#include "device_peaks.hpp"

namespace meniscus::benchmarks {

MachinePeaks measure_device_peaks() {
    throw std::runtime_error("this build has no CUDA backend");
}

}  // namespace meniscus::benchmarks
