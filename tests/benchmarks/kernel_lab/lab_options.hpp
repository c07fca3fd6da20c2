// The cases of the kernel lab, from its command line. Without CLI11, so that it builds where nothing is installed.
#pragma once

#include <cstddef>
#include <vector>

#include "meniscus/backend_options.hpp"
#include "meniscus/settings.hpp"
#include "water.hpp"

namespace meniscus::benchmarks {

struct LabOptions {
    std::vector<std::size_t> particles{basin_particles, 64 * basin_particles};
    std::vector<double> cell_sizes{1.0};  ///< radii
    std::vector<Field> fields{Field::smooth};
    std::vector<Mode> modes{Mode::uniform, Mode::adaptive};
    std::vector<WaterKind> waters{WaterKind::splashing};
    Backend backend = Backend::cuda;  ///< the one that is compared with the CPU and timed
    unsigned runs = 20;               ///< runs of a warm frame, of which the median counts
    bool compare = true;
    bool kernels = false;  ///< whether each kernel is timed, too
};

/// Throws InvalidInput for what is not known, with what is.
LabOptions read_lab_options(int argc, const char* const* argv);

/// The text of --help.
const char* lab_help();

}  // namespace meniscus::benchmarks
