// Values of an attribute as the numbers that stand for them in bricks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "meniscus/attribute_coding.hpp"

namespace meniscus {

/// One component of an attribute with bits: steps from the lower end of its range.
class CodedRange {
public:
    CodedRange(const CodedAttribute& form, std::size_t component)
        : minimum_(form.minimum[component]),
          extent_(double{form.maximum[component]} - minimum_),
          steps_(static_cast<double>((1U << form.bits) - 1)),
          steps_per_unit_(extent_ > 0.0 ? steps_ / extent_ : 0.0) {}

    /// Of the nearest step; value: within the range.
    std::uint32_t number(float value) const {
        return static_cast<std::uint32_t>(std::clamp((value - minimum_) * steps_per_unit_ + 0.5, 0.0, steps_));
    }
    /// number: at most 2^bits - 1.
    float value(std::uint32_t number) const { return static_cast<float>(minimum_ + number * extent_ / steps_); }

private:
    double minimum_;
    double extent_;
    double steps_;
    double steps_per_unit_;
};

}  // namespace meniscus
