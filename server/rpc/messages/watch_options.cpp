#include "rpc/messages/watch_options.hpp"

#include <fmt/format.h>

#include <cmath>

#include "conversion/attribute_conversion.hpp"
#include "conversion/settings_conversion.hpp"
#include "meniscus/error.hpp"
#include "meniscus/mesh.hpp"
#include "rpc/messages/normal_bits.hpp"
#include "sessions/watching/canonical_attributes.hpp"

namespace meniscus::server {

namespace {

template <class Request>
int position_bits_of(const Request& request, const Settings& settings) {
    const std::uint32_t finest = offset_bits(settings);
    if (!request.has_position_bits()) return static_cast<int>(finest);
    const std::uint32_t bits = request.position_bits();
    if (bits < min_offset_bits || bits > finest)
        throw InvalidInput(fmt::format("position_bits is {}; it must be {} to {}, the session's, or not set", bits,
                                       min_offset_bits, finest));
    return static_cast<int>(bits);
}

template <class Request>
int max_level_of(const Request& request) {
    if (!request.has_max_level()) return 3;
    const std::uint32_t level = request.max_level();
    if (level < 1 || level > 3)
        throw InvalidInput(fmt::format("max_level is {}; it must be 1 to 3, or not set", level));
    return static_cast<int>(level);
}

template <class Request>
MeshFormat format_of(const Request& request, const Settings& settings) {
    const int normal_bits = normal_bits_of(request);  // refused out of range also where there are no normals
    return {.max_level = max_level_of(request),
            .position_bits = position_bits_of(request, settings),
            .normal_bits = settings.normals ? normal_bits : 0,
            .attributes = canonical_attributes(conversion::attribute_wishes(request.attributes()), settings)};
}

Box region_of(const v1::Box& wire) {
    const Box box = conversion::from_wire(wire, "region");
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double low = box.min[axis];
        const double high = box.max[axis];
        if (!std::isfinite(low) || !std::isfinite(high) || !(low < high))
            throw InvalidInput(
                fmt::format("region runs from {} to {} on the {} axis; it must be finite, its min less than its max",
                            low, high, "xyz"[axis]));
    }
    return box;
}

std::array<double, 3> viewpoint_of(const v1::Vector3& wire) {
    if (!std::isfinite(wire.x()) || !std::isfinite(wire.y()) || !std::isfinite(wire.z()))
        throw InvalidInput(fmt::format("viewpoint is ({}, {}, {}); it must be finite", wire.x(), wire.y(), wire.z()));
    return {wire.x(), wire.y(), wire.z()};
}

}  // namespace

WatchOptions watch_options_of(const v1::WatchRequest& request, const Settings& settings) {
    WatchOptions options;
    options.format = format_of(request, settings);
    if (request.has_region()) options.region = region_of(request.region());
    options.bytes_per_second = request.bytes_per_second();
    options.spray = request.with_spray();
    if (request.has_viewpoint()) options.viewpoint = viewpoint_of(request.viewpoint());
    return options;
}

WatchOptions watch_options_of(const v1::SnapshotRequest& request, const Settings& settings) {
    WatchOptions options;
    options.format = format_of(request, settings);
    options.once = true;
    return options;
}

WatchOptions watch_options_of(const v1::WatchParticlesRequest& request, const Settings& /*settings*/) {
    WatchOptions options;
    options.max_particles = request.max_particles();
    return options;
}

}  // namespace meniscus::server
