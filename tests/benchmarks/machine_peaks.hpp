// What this machine can do at best, measured.
#pragma once

namespace meniscus::benchmarks {

struct MachinePeaks {
    double multiply_adds_per_second = 0.0;  ///< one core, float32, with the widest instructions that the library uses
    double copied_bytes_per_second = 0.0;   ///< one core, memory to memory: bytes that were read and written once
};

/// Takes about a second.
MachinePeaks measure_peaks();

}  // namespace meniscus::benchmarks
