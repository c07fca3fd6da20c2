#include "conversion/spray_conversion.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "meniscus/error.hpp"

namespace meniscus::conversion {

static_assert(sizeof(Point) == spray_point_bytes && std::endian::native == std::endian::little,
              "points travel as they lie in memory");

std::vector<v1::SprayPoints> to_wire(std::span<const Point> points) {
    std::vector<v1::SprayPoints> messages;
    for (; !points.empty(); points = points.subspan(std::min(points.size(), max_points_per_message)))
        messages.emplace_back().set_positions(points.data(),
                                              std::min(points.size(), max_points_per_message) * spray_point_bytes);
    return messages;
}

void append_points(const v1::SprayPoints& message, std::vector<Point>& points) {
    const std::string& bytes = message.positions();
    const std::size_t count = bytes.size() / spray_point_bytes;
    if (count == 0 || count > max_points_per_message || bytes.size() % spray_point_bytes != 0)
        throw InvalidInput("a message with " + std::to_string(bytes.size()) + " bytes of spray; it must have 1 to " +
                           std::to_string(max_points_per_message) + " points of " + std::to_string(spray_point_bytes) +
                           " bytes");
    const std::size_t first = points.size();
    points.resize(first + count);
    std::memcpy(points.data() + first, bytes.data(), bytes.size());
    for (std::size_t i = first; i < points.size(); ++i)
        if (!std::ranges::all_of(points[i], [](float x) { return std::isfinite(x); }))
            throw InvalidInput("point " + std::to_string(i) + " of the spray is not finite");
}

}  // namespace meniscus::conversion
