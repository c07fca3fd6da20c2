#include "surfaces/figures.hpp"

#include "conversion/statistics_conversion.hpp"

namespace meniscus::python {

std::string figure_bytes(const Statistics& figures) {
    v1::FrameStatistics wire;
    conversion::to_wire(figures, wire);
    return wire.SerializeAsString();
}

std::optional<Statistics> figures_of(const std::string& bytes) {
    v1::FrameStatistics wire;
    if (!wire.ParseFromString(bytes)) return std::nullopt;
    return conversion::from_wire(wire);
}

}  // namespace meniscus::python
