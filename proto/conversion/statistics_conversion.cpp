#include "conversion/statistics_conversion.hpp"

#include <string_view>

#include "meniscus/quoted.hpp"
#include "rows/message_rows.hpp"

namespace meniscus::conversion {

void to_wire(const Statistics& statistics, v1::FrameStatistics& wire) {
    rows::fill_message(statistics, wire);
}

Statistics from_wire(const v1::FrameStatistics& wire) {
    Statistics statistics;
    rows::fill_record(wire, statistics, [](std::string_view, int) {});
    for (Warning& warning : statistics.warnings) warning.text = escaped(warning.text, max_warning_characters);
    return statistics;
}

}  // namespace meniscus::conversion
