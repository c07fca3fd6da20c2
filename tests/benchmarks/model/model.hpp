// meniscus-bench kernels --model: the time of each launch of a warm frame on a GPU that is not there. The kernels' PTX
// runs on the device in software's memory, warp by warp (ptx_grid.hpp); what it counts is priced by the constants of
// gpus.csv and instructions.csv (price.hpp).
#pragma once

#include "gpu/kernels_options.hpp"

namespace meniscus::benchmarks {

/// Throws InvalidInput for a GPU without a row, std::runtime_error where PTX and this build do not fit.
void run_model(const KernelsOptions& options);

}  // namespace meniscus::benchmarks
