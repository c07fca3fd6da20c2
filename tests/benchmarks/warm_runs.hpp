// One frame reconstructed again and again, as a simulation's frames would be.
#pragma once

#include <vector>

#include "meniscus/reconstructor.hpp"

namespace meniscus::benchmarks {

struct RepeatLimits {
    unsigned runs = 5;      ///< warm runs, at least 1
    double seconds = 60.0;  ///< after which no further warm run begins
};

struct WarmRuns {
    Statistics first;    ///< run of a new reconstructor, whose memory is not there yet
    Statistics median;   ///< the warm run of median total time (the lower of two in the middle)
    unsigned count = 0;  ///< warm runs
};

/// Reconstructs `frame` with a new reconstructor, then warm as often as `limits` allow. `mesh` is the last run's.
WarmRuns reconstruct_repeatedly(const ParticleFrame& frame, const Settings& settings, const BackendOptions& options,
                                const RepeatLimits& limits, Mesh& mesh);

/// The median of at least one value; the lower of two in the middle.
double median(std::vector<double> values);

}  // namespace meniscus::benchmarks
