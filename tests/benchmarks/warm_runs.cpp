#include "warm_runs.hpp"

#include <algorithm>
#include <vector>

namespace meniscus::benchmarks {

WarmRuns reconstruct_repeatedly(const ParticleFrame& frame, const Settings& settings, const BackendOptions& options,
                                const RepeatLimits& limits, Mesh& mesh) {
    Reconstructor reconstructor(settings, options);
    WarmRuns result;
    reconstructor.reconstruct(frame, mesh);
    result.first = reconstructor.statistics();
    std::vector<Statistics> warm;
    double seconds = 0.0;
    while (warm.empty() || (warm.size() < limits.runs && seconds < limits.seconds)) {
        reconstructor.reconstruct(frame, mesh);
        warm.push_back(reconstructor.statistics());
        seconds += warm.back().total_seconds;
    }
    std::stable_sort(warm.begin(), warm.end(),
                     [](const Statistics& a, const Statistics& b) { return a.total_seconds < b.total_seconds; });
    result.count = static_cast<unsigned>(warm.size());
    result.median = warm[(warm.size() - 1) / 2];
    return result;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[(values.size() - 1) / 2];
}

}  // namespace meniscus::benchmarks
