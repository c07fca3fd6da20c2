// The peaks of this machine's processor, measured.
#pragma once

namespace meniscus::benchmarks {

struct MachinePeaks {
    double multiply_adds_per_second = 0.0;  ///< float32
    double copied_bytes_per_second = 0.0;   ///< memory to memory: bytes that were read and written once
};

/// The peaks of one core, with the widest instructions that the library uses. Takes about a second.
MachinePeaks measure_peaks();

}  // namespace meniscus::benchmarks
