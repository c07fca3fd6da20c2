#include "conversion/statistics_conversion.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include "described/message_rows.hpp"

namespace meniscus::conversion {

namespace {

/// One line that a terminal takes for text, whatever it was: control characters become question marks. Not longer than
/// max_warning_bytes; a character of several bytes is not cut.
std::string one_line(std::string_view text) {
    std::size_t length = std::min(text.size(), max_warning_bytes);
    if (length < text.size())
        while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) --length;
    std::string line(text.substr(0, length));
    for (std::size_t i = 0; i < line.size(); ++i) {
        const auto byte = static_cast<unsigned char>(line[i]);
        if (byte < 0x20 || byte == 0x7F) line[i] = '?';
        // U+0080 to U+009F control terminals, too.
        if (byte == 0xC2 && i + 1 < line.size() && static_cast<unsigned char>(line[i + 1]) < 0xA0)
            line.replace(i, 2, "?");
    }
    return line;
}

}  // namespace

void to_wire(const Statistics& statistics, v1::FrameStatistics& wire) {
    described::fill_message(statistics, wire);
}

Statistics from_wire(const v1::FrameStatistics& wire) {
    Statistics statistics;
    described::fill_record(wire, statistics, [](std::string_view, int) {});
    if (statistics.warnings.size() > max_warnings) statistics.warnings.resize(max_warnings);
    for (Warning& warning : statistics.warnings) warning.text = one_line(warning.text);
    return statistics;
}

}  // namespace meniscus::conversion
