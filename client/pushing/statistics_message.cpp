#include "pushing/statistics_message.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "meniscus/warning.hpp"

namespace meniscus::pushing {
namespace {

/// The numbers of the rows' fields: proto/meniscus/v1/mesh.proto.
constexpr std::array<std::pair<std::string_view, unsigned>, 20> fields{{{"particles", 3},
                                                                        {"vertices", 4},
                                                                        {"triangles", 5},
                                                                        {"triangles_by_level", 6},
                                                                        {"base_cells_by_level", 7},
                                                                        {"field_evaluations", 8},
                                                                        {"stage_seconds", 9},
                                                                        {"total_seconds", 10},
                                                                        {"peak_bytes", 13},
                                                                        {"allocations", 14},
                                                                        {"backend", 15},
                                                                        {"threads", 16},
                                                                        {"device_bytes", 18},
                                                                        {"device_peak_bytes", 19},
                                                                        {"download_seconds", 20},
                                                                        {"spray_particles", 21},
                                                                        {"volume", 22},
                                                                        {"particle_volume", 23},
                                                                        {"warnings", 24},
                                                                        {"vertices_without_particles", 25}}};
constexpr unsigned warning_code = 1, warning_value = 2, warning_limit = 3, warning_text = 4;

unsigned field_of(std::string_view name) {
    const auto found = std::find_if(fields.begin(), fields.end(), [name](const auto& f) { return f.first == name; });
    if (found == fields.end()) throw std::logic_error("FrameStatistics has no field " + std::string(name));
    return found->second;
}

template <class Value>
void add(Message& message, unsigned field, const Value& value) {
    if constexpr (std::is_same_v<Value, double>) {
        message.real(field, value);
    } else if constexpr (std::is_arithmetic_v<Value>) {
        message.number(field, value);
    } else if constexpr (std::is_same_v<Value, std::string>) {
        message.text(field, value);
    } else {
        // An array's entries are numbered in its order.
        Message entries;
        for (std::size_t i = 0; i < value.size(); ++i) add(entries, static_cast<unsigned>(i + 1), value[i]);
        message.message(field, entries);
    }
}

void add(Message& message, unsigned field, const std::vector<Warning>& warnings) {
    for (const Warning& warning : warnings)
        message.message(field, Message()
                                   .number(warning_code, static_cast<std::uint64_t>(warning.code))
                                   .real(warning_value, warning.value)
                                   .real(warning_limit, warning.limit)
                                   .text(warning_text, warning.text));
}

}  // namespace

Message statistics_message(const Statistics& statistics) {
    Message message;
    Statistics::rows([&](std::string_view name, auto member, const Facts& /*facts*/) {
        add(message, field_of(name), statistics.*member);
    });
    return message;
}

}  // namespace meniscus::pushing
