#include "cli/print/statistics_text.hpp"

#include <sstream>

#include "meniscus/names.hpp"

namespace meniscus::cli {

std::string summary(const Statistics& statistics) {
    std::ostringstream text;
    text << statistics.particles << " particles, " << statistics.triangles << " triangles, " << statistics.total_seconds
         << " s";
    return text.str();
}

std::string stages_text(const Statistics& statistics) {
    std::ostringstream text;
    text << "  " << statistics.vertices << " vertices, " << statistics.field_evaluations << " field evaluations, "
         << statistics.peak_bytes << " bytes at most, " << statistics.backend << '\n'
         << " ";
    const char* separator = " ";
    for (const Stage stage : choices<Stage>) {
        text << separator << name_of(stage) << ' ' << statistics.stage_seconds[static_cast<std::size_t>(stage)] << " s";
        separator = ", ";
    }
    text << '\n';
    return text.str();
}

}  // namespace meniscus::cli
