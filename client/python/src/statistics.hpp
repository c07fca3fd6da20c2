// Figures as the keywords of meniscus.Statistics.
#pragma once

#include <pybind11/pybind11.h>

#include "meniscus/client/frame_statistics.hpp"
#include "meniscus/statistics.hpp"

namespace meniscus::python {

pybind11::dict to_dict(const Statistics& statistics);
pybind11::dict to_dict(const client::FrameStatistics& statistics);

}  // namespace meniscus::python
