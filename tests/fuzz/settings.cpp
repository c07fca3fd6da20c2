#include "conversion/settings_conversion.hpp"
#include "support.hpp"

namespace meniscus::fuzz {

void settings(Bytes bytes) {
    v1::Settings wire;
    if (!wire.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return;
    may_refuse([&] {
        const Settings settings = conversion::from_wire(wire);
        validate(settings);
        require(conversion::from_wire(conversion::to_wire(settings)) == settings, "settings survive the wire");
    });
}

Seeds settings_seeds() {
    Settings plain;
    plain.particle_radius = 0.1;
    Settings full = plain;
    full.field = Field::density;
    full.criterion = CountCriterion{2};
    full.edge_points = Bisection{3};
    full.domain = Box{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};
    Settings smooth = plain;
    smooth.field = Field::smooth;
    smooth.smoothness = 7;
    smooth.spray = Spray::points;
    return {conversion::to_wire(plain).SerializeAsString(), conversion::to_wire(full).SerializeAsString(),
            conversion::to_wire(smooth).SerializeAsString()};
}

}  // namespace meniscus::fuzz
