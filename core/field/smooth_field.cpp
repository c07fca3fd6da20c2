// The experiments behind these numbers are in core/README.md#the-smooth-field.
#include "field/smooth_field.hpp"

#include <cmath>

#include "lattice/coordinates.hpp"

namespace meniscus {

SmoothField::SmoothField(std::uint32_t smoothness, double cell_size) {
    for (std::size_t k = 0; k < units_per_radius.size(); ++k)
        units_per_radius[k] = static_cast<float>(std::ldexp(units_per_cell / cell_size, static_cast<int>(k)));
    widest_support = static_cast<float>(smoothness);
    switch (smoothness) {
        case 5:
            company_support = 4.0F;
            least_value = 0.82F;
            group_lift = 0.065F;
            deep_inside = 0.80F;
            break;
        case 7:
            company_support = 4.75F;
            least_value = 0.70F;
            group_lift = 0.045F;
            deep_inside = 0.72F;
            break;
        default:
            company_support = 4.5F;
            least_value = 0.75F;
            group_lift = 0.065F;
            deep_inside = 0.72F;
    }
}

}  // namespace meniscus
